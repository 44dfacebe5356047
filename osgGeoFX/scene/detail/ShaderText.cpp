// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/ShaderText.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace osgGeoFX
{

namespace
{

bool isPartOfWord(char letter)
{
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}

/// As long as the text, line by line, so that places are the same in both.
std::string withoutComments(const std::string& text)
{
    std::string result = text;
    for (std::size_t i = 0; i < text.size();)
    {
        const bool line = text.compare(i, 2, "//") == 0;
        if (!line && text.compare(i, 2, "/*") != 0)
        {
            ++i;
            continue;
        }
        std::size_t end = line ? text.find('\n', i) : text.find("*/", i + 2);
        end = end == std::string::npos ? text.size() : end + (line ? 0 : 2);
        std::replace_if(
            result.begin() + static_cast<std::ptrdiff_t>(i),
            result.begin() + static_cast<std::ptrdiff_t>(end), [](char letter) { return letter != '\n'; },
            ' ');
        i = end;
    }
    return result;
}

} // namespace

ShaderText::ShaderText(const std::string& source) : _source(source), _code(withoutComments(source))
{
    tokenize();
    readVersion();
}

void ShaderText::tokenize()
{
    bool directive = false;
    bool lineStarts = true;
    for (std::size_t i = 0; i < _code.size();)
    {
        const char letter = _code[i];
        if (letter == '\\' && i + 1 < _code.size() && _code[i + 1] == '\n')
        {
            i += 2; // the line goes on
            continue;
        }
        if (letter == '\n')
        {
            directive = false;
            lineStarts = true;
        }
        if (std::isspace(static_cast<unsigned char>(letter)) != 0)
        {
            ++i;
            continue;
        }
        if (lineStarts && letter == '#') directive = true;
        lineStarts = false;
        std::size_t end = i + 1;
        if (isPartOfWord(letter))
        {
            while (end < _code.size() && isPartOfWord(_code[end]))
                ++end;
        }
        _tokens.push_back({_code.substr(i, end - i), i, directive});
        i = end;
    }
}

void ShaderText::readVersion()
{
    const auto startOfNextLine = [&](std::size_t token)
    {
        const std::size_t end = _code.find('\n', _tokens[token].at);
        return end == std::string::npos ? _code.size() : end + 1;
    };
    // OSG puts a version there, as osgText's shaders have it.
    if (is(0, "$") && is(1, "OSG_GLSL_VERSION")) _afterVersion = startOfNextLine(1);
    if (_tokens.size() < 3 || !is(0, "#") || !is(1, "version")) return;
    _version = std::atoi(_tokens[2].text.c_str());
    _afterVersion = startOfNextLine(2);
    const bool profile = _tokens.size() > 3 && _tokens[3].at < _afterVersion;
    _embedded = _version == 100 || (profile && _tokens[3].text == "es");
}

bool ShaderText::is(std::size_t token, const char* text) const
{
    return token < _tokens.size() && _tokens[token].text == text;
}

bool ShaderText::names(const std::string& word) const
{
    return std::any_of(_tokens.begin(), _tokens.end(), [&](const Token& each) { return each.text == word; });
}

bool ShaderText::namesLike(const std::string& beginning) const
{
    return std::any_of(_tokens.begin(), _tokens.end(),
                       [&](const Token& each) { return each.text.rfind(beginning, 0) == 0; });
}

bool ShaderText::redefines(const std::string& word) const
{
    for (std::size_t i = 2; i < _tokens.size(); ++i)
    {
        if (_tokens[i].text == word && _tokens[i].directive && is(i - 2, "#") &&
            (is(i - 1, "define") || is(i - 1, "undef")))
            return true;
    }
    return false;
}

bool ShaderText::declaresOut(const std::string& block) const
{
    for (std::size_t i = 1; i < _tokens.size(); ++i)
    {
        if (_tokens[i].text == block && is(i - 1, "out")) return true;
    }
    return false;
}

bool ShaderText::assignsFrom(const std::string& variable, const std::string& word) const
{
    bool found = false;
    for (std::size_t i = 0; i + 1 < _tokens.size(); ++i)
    {
        if (_tokens[i].text != variable || !is(i + 1, "=") || is(i + 2, "=")) continue;
        std::size_t end = i + 2;
        bool from = false;
        for (; end < _tokens.size() && !is(end, ";"); ++end)
            from = from || is(end, word.c_str());
        if (!from) return false;
        found = true;
    }
    return found;
}

std::size_t ShaderText::closing(std::size_t open) const
{
    int depth = 0;
    for (std::size_t i = open; i < _tokens.size(); ++i)
    {
        depth += is(i, "(") ? 1 : 0;
        depth -= is(i, ")") ? 1 : 0;
        if (depth == 0) return i;
    }
    return _tokens.size();
}

ShaderText::Output ShaderText::outputAt(std::size_t out) const
{
    Output output;
    std::size_t next = out + 1;
    while (is(next, "highp") || is(next, "mediump") || is(next, "lowp"))
        ++next;
    if (next + 1 >= _tokens.size()) return output;
    output.type = _tokens[next].text;
    std::size_t end = next + 2;
    output.array = is(end, "[");
    while (output.array && end < _tokens.size() && !is(end - 1, "]"))
        ++end;
    // Anything else is a parameter of a function, a block, or several in one declaration.
    if (is(end, ";")) output.name = _tokens[next + 1].text;
    return output;
}

std::vector<ShaderText::Output> ShaderText::outputs() const
{
    std::vector<Output> all;
    int location = -1;
    for (std::size_t i = 0; i < _tokens.size(); ++i)
    {
        if (_tokens[i].directive) continue;
        if (is(i, ";") || is(i, "}")) location = -1;
        if (is(i, "layout") && is(i + 1, "("))
        {
            const std::size_t end = closing(i + 1);
            for (std::size_t each = i + 2; each + 2 < end; ++each)
            {
                if (is(each, "location") && is(each + 1, "="))
                    location = std::atoi(_tokens[each + 2].text.c_str());
            }
            i = end;
            continue;
        }
        if (!is(i, "out")) continue;
        Output output = outputAt(i);
        output.location = location;
        if (!output.name.empty()) all.push_back(output);
    }
    return all;
}

std::string ShaderText::withDirective(const std::string& directive) const
{
    const auto lines =
        std::count(_source.begin(), _source.begin() + static_cast<std::ptrdiff_t>(_afterVersion), '\n');
    // Before version 330 #line counted from the line behind it.
    const bool early = _version < 330;
    std::string text = _source.substr(0, _afterVersion);
    if (!text.empty() && text.back() != '\n') text += '\n';
    text += directive;
    text += "\n#line " + std::to_string(lines + (early ? 0 : 1)) + '\n';
    return text + _source.substr(_afterVersion);
}

int ShaderText::depthChange(const std::string& directive)
{
    if (directive == "if" || directive == "ifdef" || directive == "ifndef") return 1;
    return directive == "endif" ? -1 : 0;
}

bool ShaderText::addDeclaration(const std::string& declaration, std::string& text) const
{
    int depth = 0;
    std::size_t place = std::string::npos; // of the first declaration, or of the conditions around it
    std::size_t outermost = 0;
    for (std::size_t i = 0; i < _tokens.size(); ++i)
    {
        const bool starts = _tokens[i].directive && is(i, "#") && i + 1 < _tokens.size();
        if (starts)
        {
            const std::string& word = _tokens[i + 1].text;
            if (depth == 0) outermost = _tokens[i].at;
            depth += depthChange(word);
            if (place != std::string::npos && word == "extension") return false;
        }
        if (!_tokens[i].directive && place == std::string::npos)
            place = depth > 0 ? outermost : _tokens[i].at;
    }
    if (place == std::string::npos) return false;
    // The given text has lines more before that place, and the rest is the same.
    const std::size_t shift = text.size() - _source.size();
    // A directive begins a line.
    text.insert(place + shift, declaration + (_code[place] == '#' ? '\n' : ' '));
    return true;
}

} // namespace osgGeoFX
