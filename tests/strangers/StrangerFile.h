// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The collections of awkward files: plain text, so that a new file is a few lines. README.md has their form.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace geofx::test::strangers
{

/// A file that a case writes.
struct StrangerText
{
    std::string name;
    std::vector<std::string> flags; ///< crlf, bom, latin1, utf16, cut=N
    std::string text;
};

/// A line of a case: a question with its answer, or something that is made.
struct StrangerStep
{
    int line = 0; ///< of the collection, from 1
    std::vector<std::string> words;
    bool isAsked = false; ///< whether it has an answer
    std::string answer;
    std::vector<std::string> told; ///< messages that come with it, in their order
};

struct Stranger
{
    std::string name;
    std::vector<StrangerText> files;
    std::vector<StrangerStep> steps;
};

/// Words between spaces; those in single quotes may have spaces.
inline std::vector<std::string> wordsOf(const std::string& text)
{
    std::vector<std::string> words;
    bool isOpen = false, isQuoted = false;
    for (const char each : text)
    {
        if (each == '\'')
        {
            isQuoted = !isQuoted;
            if (!isOpen) words.emplace_back();
            isOpen = true;
        }
        else if (each == ' ' && !isQuoted)
            isOpen = false;
        else
        {
            if (!isOpen) words.emplace_back();
            isOpen = true;
            words.back() += each;
        }
    }
    return words;
}

inline bool beginsWith(const std::string& text, const std::string& start)
{
    return text.rfind(start, 0) == 0;
}

/// Reads a collection. Throws std::runtime_error with the line.
inline std::vector<Stranger> readStrangers(const std::string& file)
{
    std::ifstream stream(file);
    std::vector<Stranger> result;
    int number = 0;
    bool isText = false;
    const auto fail = [&](const std::string& what)
    {
        throw std::runtime_error(file + ":" + std::to_string(number) + ": " + what);
    };
    for (std::string line; std::getline(stream, line);)
    {
        ++number;
        if (beginsWith(line, "=== "))
        {
            result.emplace_back();
            result.back().name = line.substr(4);
            isText = false;
            continue;
        }
        if (result.empty()) continue; // the page's head
        Stranger& now = result.back();
        if (beginsWith(line, "--- "))
        {
            const std::vector<std::string> words = wordsOf(line.substr(4));
            if (words.empty()) fail("a file without a name");
            now.files.push_back({words[0], {words.begin() + 1, words.end()}, ""});
            isText = true;
        }
        else if (beginsWith(line, ">>> told "))
        {
            if (now.steps.empty()) fail("a message before the first question");
            now.steps.back().told.push_back(line.substr(9));
            isText = false;
        }
        else if (beginsWith(line, ">>> "))
        {
            StrangerStep step;
            step.line = number;
            const std::size_t arrow = line.find(" -> ");
            step.words = wordsOf(line.substr(4, arrow == std::string::npos ? arrow : arrow - 4));
            step.isAsked = arrow != std::string::npos;
            if (step.isAsked) step.answer = line.substr(arrow + 4);
            if (step.words.empty()) fail("a question without words");
            now.steps.push_back(step);
            isText = false;
        }
        else if (isText)
            now.files.back().text += line + "\n";
        else if (!line.empty() && line[0] != '#')
            fail("neither a case, a file, a question nor a comment");
    }
    return result;
}

/// Whether a text is as a pattern says, where "…" stands for anything.
inline bool matchesWords(const std::string& text, const std::string& pattern)
{
    const std::string gap = "…";
    std::size_t from = 0, at = 0;
    for (bool isFirst = true;; isFirst = false)
    {
        const std::size_t end = pattern.find(gap, at);
        const std::string part = pattern.substr(at, end == std::string::npos ? end : end - at);
        if (end == std::string::npos)
            return isFirst ? text == part
                           : text.size() >= from + part.size() &&
                                 text.compare(text.size() - part.size(), part.size(), part) == 0;
        const std::size_t found = text.find(part, from);
        if (found == std::string::npos || (isFirst && found != 0)) return false;
        from = found + part.size();
        at = end + gap.size();
    }
}

/// The same, where numbers are equal within a millionth, or within what stands behind "~": 12.5~0.1.
inline bool isAnswer(const std::string& text, const std::string& expected)
{
    if (matchesWords(text, expected)) return true;
    const auto pieces = [](const std::string& line)
    {
        std::istringstream stream(line);
        return std::vector<std::string>(std::istream_iterator<std::string>(stream), {});
    };
    const std::vector<std::string> got = pieces(text), wanted = pieces(expected);
    const auto number = [](const std::string& word, double& value, std::string& rest)
    {
        char* end = nullptr;
        value = std::strtod(word.c_str(), &end);
        rest = end;
        return end != word.c_str();
    };
    return std::equal(got.begin(), got.end(), wanted.begin(), wanted.end(),
                      [&](const std::string& a, const std::string& b)
                      {
                          if (a == b) return true;
                          double x = 0.0, y = 0.0;
                          std::string rest, tolerance;
                          if (!number(a, x, rest) || !rest.empty() || !number(b, y, tolerance)) return false;
                          if (!tolerance.empty() && tolerance[0] != '~') return false;
                          const double most = tolerance.empty() ? 1e-6 * std::max(1.0, std::abs(y))
                                                                : std::atof(tolerance.c_str() + 1);
                          return std::abs(x - y) <= most;
                      });
}

} // namespace geofx::test::strangers
