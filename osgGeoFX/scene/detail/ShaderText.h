// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** What can be told of a GLSL shader from its text: its words, comments apart, and its outputs. Conditions such as #ifdef are not
    worked out, so what stands under any of them counts. */
class ShaderText
{
public:
    explicit ShaderText(const std::string& source);

    /// 110 where there is no #version.
    int version() const { return _version; }
    /// OpenGL ES.
    bool embedded() const { return _embedded; }
    /// Whether a word stands anywhere, in directives, too.
    bool names(const std::string& word) const;
    /// Whether a word stands anywhere that begins so.
    bool namesLike(const std::string& beginning) const;
    /// Whether a directive defines a word, or takes its definition back.
    bool redefines(const std::string& word) const;
    /// Whether a block of this name is declared anew: a word `out` before it.
    bool declaresOut(const std::string& block) const;
    /// Whether values of a variable come from another word, in all statements that assign it.
    bool assignsFrom(const std::string& variable, const std::string& word) const;

    /// A variable that the fragment stage puts out.
    struct Output
    {
        std::string type, name;
        int location = -1; ///< -1 where the text does not tell
        bool array = false;
    };
    std::vector<Output> outputs() const;

    /** The text with a line behind its #version: `directive`, without its end. The lines after it keep their numbers in the
        compiler's messages. */
    std::string withDirective(const std::string& directive) const;
    /// The same with a declaration before the first one of its own, behind all of its #extension. False where there is no such place.
    bool addDeclaration(const std::string& declaration, std::string& text) const;

private:
    struct Token
    {
        std::string text;
        std::size_t at = 0;
        bool directive = false; ///< in a line that begins with #
    };
    void tokenize();
    void readVersion();
    /// How deep in conditions each directive's line stands is counted up or down by this.
    static int depthChange(const std::string& directive);
    bool is(std::size_t token, const char* text) const;
    std::size_t closing(std::size_t open) const;
    Output outputAt(std::size_t out) const;

    std::string _source;
    std::string _code; ///< the source with spaces in the place of comments
    std::vector<Token> _tokens;
    int _version = 110;
    bool _embedded = false;
    std::size_t _afterVersion = 0; ///< where the line behind #version begins
};

} // namespace osgGeoFX
