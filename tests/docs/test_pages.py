#!/usr/bin/python3
"""Links lead somewhere, pictures exist and are used; the citation and the issue templates say what they have to."""

import glob
import os
import re
import unittest

import pages
import yaml

PAGES = pages.all_pages()
ANCHORS = {page.path: page.anchors() for page in PAGES}


class Pages(unittest.TestCase):
    def every(self, found):
        self.assertEqual(list(found), [])

    def targets(self):
        """Page, line, whether it is a picture, file and anchor of each link inside the repository."""
        for page in PAGES:
            for line, picture, target in page.links():
                if "://" in target or target.startswith("mailto:"):
                    continue
                path, _, anchor = target.partition("#")
                file = os.path.normpath(os.path.join(os.path.dirname(page.path), path)) if path else page.path
                yield f"{page.name}:{line}", picture, file, anchor

    def test_links_lead_somewhere(self):
        self.assertGreater(sum(1 for _ in self.targets()), 50)
        self.every(f"{where}: there is no {os.path.relpath(file, pages.ROOT)}"
                   for where, _, file, _ in self.targets() if not os.path.exists(file))

    def test_anchors_are_headings(self):
        self.every(f"{where}: {os.path.relpath(file, pages.ROOT)} has no heading {anchor}"
                   for where, _, file, anchor in self.targets()
                   if anchor and file in ANCHORS and anchor not in ANCHORS[file])

    def test_pictures_are_used(self):
        used = {file for _, picture, file, _ in self.targets() if picture}
        found = set(pages.pictures())
        self.assertTrue(found)
        self.every(sorted(os.path.relpath(path, pages.ROOT) for path in found - used))

    def test_every_page_is_reached_from_the_list(self):
        """By links from docs/README.md."""
        reached, new = set(), {os.path.join(pages.DOCS, "README.md")}
        links = {page.path: set() for page in PAGES}
        for where, _, file, _ in self.targets():
            links[os.path.join(pages.ROOT, where.rpartition(":")[0])].add(file)
        while new:
            reached |= new
            new = {file for path in new for file in links.get(path, ())} - reached
        self.every(page.name for page in PAGES if page.path.startswith(pages.DOCS) and page.path not in reached)


def load(*names):
    with open(os.path.join(pages.ROOT, *names), encoding="utf-8") as file:
        return yaml.safe_load(file)


class Metadata(unittest.TestCase):
    def test_citation(self):
        """As the Citation File Format 1.2.0 wants it; it names the reference work."""
        citation = load("CITATION.cff")
        self.assertEqual(citation["cff-version"], "1.2.0")
        self.assertLessEqual({"message", "title", "authors", "references"}, set(citation))
        with open(os.path.join(pages.ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
            self.assertEqual(citation["version"], re.search(r"VERSION (\d+\.\d+\.\d+)", file.read()).group(1))
        work = citation["references"][0]
        self.assertEqual((work["type"], work["year"], work["authors"][0]["family-names"]), ("thesis", 2013, "Strunk"))
        self.assertEqual(work["title"],
                         "High performance adaptive finite element modeling of complex CAD geometry")

    def test_issue_templates(self):
        paths = glob.glob(os.path.join(pages.ROOT, ".github", "ISSUE_TEMPLATE", "*.yml"))
        forms = {os.path.basename(path): load(path) for path in paths}
        self.assertIs(forms.pop("config.yml")["blank_issues_enabled"], True)
        self.assertGreaterEqual(len(forms), 3)
        for name, form in forms.items():
            with self.subTest(form=name):
                self.assertLessEqual({"name", "description", "body"}, set(form))
                ids = [item["id"] for item in form["body"] if item["type"] != "markdown"]
                self.assertEqual(len(ids), len(set(ids)))
                self.assertTrue(all(item["attributes"] for item in form["body"]))

    def test_workflow(self):
        """It runs .ci/run on both releases of Debian."""
        jobs = load(".github", "workflows", "ci.yml")["jobs"]
        job = jobs["debian"]
        self.assertEqual(job["strategy"]["matrix"]["debian"], [12, 13])
        self.assertEqual(job["container"]["image"], "debian:${{ matrix.debian }}")
        self.assertIn(".ci/run", [step.get("run") for step in job["steps"]])

    def test_recipes_name_the_version(self):
        version = load("CITATION.cff")["version"]
        for path, line in (("Dockerfile", f'org.opencontainers.image.version="{version}"'),
                           ("plugin/package/spack/package.py", f'version("{version}")'),
                           ("plugin/package/conda/meta.yaml", f'set version = "{version}"')):
            with open(os.path.join(pages.ROOT, path), encoding="utf-8") as file:
                text = file.read()
            self.assertIn(line, text, path)
            if path.endswith(".py"):
                compile(text, path, "exec")
            elif path.endswith(".yaml"):
                plain = re.sub(r"{{.*?}}", "x", re.sub(r"{%.*?%}", "", text))
                self.assertEqual(set(yaml.safe_load(plain)),
                                 {"package", "source", "build", "requirements", "test", "about"})

    def test_changes_name_the_version(self):
        page = next(page for page in PAGES if page.name == "CHANGELOG.md")
        self.assertTrue(any(line.startswith(f"## {load('CITATION.cff')['version']} ") for line in page.lines))


if __name__ == "__main__":
    unittest.main()
