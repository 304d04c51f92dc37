#!/usr/bin/python3
"""The tables of docs/filters say of each property of each proxy what xml/ says: values and default."""

import glob
import os
import re
import unittest
import xml.etree.ElementTree as ElementTree

import pages

FILTERS = [page for page in pages.all_pages() if os.path.dirname(page.path) == os.path.join(pages.DOCS, "filters")]
PROXY = re.compile(r"[Tt]he proxy is\s+`(\w+)`")
PART = re.compile(r"<\?part (\w+)([^?]*)\?>")  # As filters/ServerManagerXMLs.cmake has it.


def proxies():
    for path in sorted(glob.glob(os.path.join(pages.ROOT, "xml", "*.xml"))):
        root = ElementTree.fromstring(PART.sub(part, text_of(path)))
        for proxy in root.iterfind("ProxyGroup[@name!='internal_filters']/*"):
            if proxy.tag in ("SourceProxy", "WriterProxy") and not proxy.get("base_proxyname"):  # Else an old name.
                yield proxy


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def part(match):
    """What stands for the line: a file of xml/parts with the values of its keys."""
    values = dict(re.findall(r'(\w+)="([^"]*)"', match[2]))
    text = text_of(os.path.join(pages.ROOT, "xml", "parts", match[1] + ".xml"))
    return re.sub(r"@(\w+)@", lambda key: values[key[1]], text)


def properties(proxy):
    """The properties that are set by the user, inputs left out."""
    return [item for item in proxy if item.tag.endswith("VectorProperty") and not item.get("information_only")]


def inputs(proxy):
    return [item.get("name") for item in proxy if item.tag == "InputProperty"]


def entries(item):
    return {entry.get("value"): entry.get("text") for entry in item.iter("Entry")}


def expected_default(item):
    """How a table says the default of a property."""
    value = item.get("default_values")
    if item.find("BoundsDomain") is not None:
        return "bounds of the input"
    if item.tag == "StringVectorProperty":
        return value or "none"
    if item.find("BooleanDomain") is not None:
        return {"0": "off", "1": "on"}[value]
    return "none" if value is None else entries(item).get(value, value)


def expected_values(item):
    """Texts that a table has to say about the values of a property."""
    texts = list(entries(item).values())
    for domain in item:
        if domain.tag in ("IntRangeDomain", "DoubleRangeDomain"):
            lower, upper = domain.get("min"), domain.get("max")
            texts.append(f"{lower} to {upper}" if upper else f"{lower} or more")
    return texts


def page_of(name):
    found = [page for page in FILTERS if name in PROXY.findall(" ".join(page.lines))]
    if len(found) != 1:
        raise AssertionError(f"{len(found)} pages of docs/filters say \"The proxy is `{name}`\"")
    return found[0]


def documented(page):
    """Cells of the row of each property."""
    rows = pages.table_rows(page.section("Properties"))
    return {row[0].strip("`"): row[1:] for row in rows}


class Properties(unittest.TestCase):
    def test_there_are_proxies(self):
        self.assertGreaterEqual(len(list(proxies())), 6)

    def test_each_property_has_a_row_and_no_other(self):
        for proxy in proxies():
            with self.subTest(proxy=proxy.get("name")):
                names = [item.get("name") for item in properties(proxy)]
                self.assertEqual(sorted(documented(page_of(proxy.get("name")))), sorted(names))

    def test_values_and_defaults(self):
        for proxy in proxies():
            rows = documented(page_of(proxy.get("name")))
            for item in properties(proxy):
                with self.subTest(proxy=proxy.get("name"), property=item.get("name")):
                    values, default, _ = rows[item.get("name")]
                    self.assertEqual(default, expected_default(item))
                    for text in expected_values(item):
                        self.assertIn(text, values)

    def test_inputs(self):
        for proxy in proxies():
            page = page_of(proxy.get("name"))
            text = " ".join(page.section("Inputs"))
            for name in inputs(proxy):
                with self.subTest(proxy=proxy.get("name"), input=name):
                    self.assertIn(f"`{name}`", text)

    def test_labels_are_titles(self):
        for proxy in proxies():
            self.assertEqual(page_of(proxy.get("name")).lines[0], "# " + proxy.get("label"))


if __name__ == "__main__":
    unittest.main()
