#include <cadrefine/cad/readers/step/StepNumbers.h>

#include <cadrefine/base/Error.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace cadrefine
{
namespace
{

bool isNumber(const std::string& word)
{
  return word.find_first_not_of("0123456789.+-Ee") == std::string::npos;
}

/// Whether a number is at least 1e308, from the places of its digits: turned into a double it might
/// overflow.
bool isTooLarge(const std::string& number)
{
  constexpr long most = 308;
  constexpr long beyondAll = 1000000;
  const std::size_t end = std::min(number.find_first_of("Ee"), number.size());
  const std::size_t point = std::min(number.find('.'), end);
  const std::size_t first = number.find_first_of("123456789");
  if (first >= end)
  {
    return false; // zero, or no number
  }
  const long exponent = end < number.size() ? std::strtol(&number[end] + 1, nullptr, 10) : 0;
  const long digits = static_cast<long>(point) - static_cast<long>(first) +
                      (first > point ? 1 : 0); // before the point
  return digits + std::clamp(exponent, -beyondAll, beyondAll) > most;
}

/// Takes a text one character after the other.
class NumberScan
{
public:
  explicit NumberScan(const std::string& path) : path_(path) {}

  void take(char c)
  {
    if (inString_)
    {
      inString_ = c != '\''; // a doubled one ends the string and begins another
      return;
    }
    if (isOfWord(c))
    {
      word_ += c;
      return;
    }
    endWord();
    inString_ = c == '\'';
    begins_ = c == ';' || (begins_ && std::isspace(static_cast<unsigned char>(c)) != 0);
  }

private:
  static bool isOfWord(char c)
  {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' ||
           c == '-' || c == '#';
  }

  void endWord()
  {
    if (word_.empty())
    {
      return;
    }
    if (begins_)
    {
      entity_ = word_;
      begins_ = false;
    }
    else if (isNumber(word_) && isTooLarge(word_))
    {
      throw Error(path_ + ": the file is damaged: " + entity_ +
                  " holds a number that is too large, " + word_.substr(0, 40));
    }
    word_.clear();
  }

  const std::string& path_;
  bool inString_ = false;
  bool begins_ = true; ///< Nothing but blanks since the last ';'.
  std::string word_;
  std::string entity_;
};

} // namespace

void checkStepNumbers(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  NumberScan scan(path);
  for (auto at = std::istreambuf_iterator<char>(file); at != std::istreambuf_iterator<char>(); ++at)
  {
    scan.take(*at);
  }
}

} // namespace cadrefine
