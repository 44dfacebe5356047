// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct _xmlTextReader; // libxml2's; NOLINT(bugprone-reserved-identifier)

namespace osgGeoFX
{

/// Of a text; more of them are told as a fault while it is read.
constexpr std::size_t mostKmlLinks = 10000;
inline constexpr const char* tooManyLinks =
    "the file has more than 10000 links; open one of its parts instead.";

/// Text without the spaces around it.
std::string_view trimmed(std::string_view text);
/// The whole of a text as a finite number, in every locale.
std::optional<double> numberOf(std::string_view text);

/// Whether an element is a feature, which may stand alone in a file without `<kml>` around it.
bool isKmlFeature(const std::string& name);

/** A KML text, read as a stream by libxml2: no document type, so no entities; no network; limits of depth and length. So memory does
    not grow with the number of elements. */
class KmlStream
{
public:
    virtual ~KmlStream() = default;
    KmlStream(const KmlStream&) = delete;
    KmlStream& operator=(const KmlStream&) = delete;

    /// Throws BuildError, with file and line, where the text is no KML or has more than 256 MiB.
    void parse();
    std::size_t bytes() const { return _bytes; }

protected:
    /// `document`: as GDAL opens it; must outlive this.
    explicit KmlStream(const std::string& document) : _document(document) {}

    /// An element begins, which isAt() tells; and ends, with text() before its end.
    virtual void begin() = 0;
    virtual void end() = 0;
    /// How much of the present element's text is kept, bytes.
    virtual std::size_t longestText() const { return 4096; }

    /// Whether the open elements end so, the innermost last. Names are without their namespace.
    bool isAt(std::initializer_list<const char*> names) const;
    const std::string& element() const { return _path.back(); }
    /// The element around the present one; empty if there is none.
    const std::string& parent() const;
    /// The one around that.
    const std::string& grandparent() const;
    std::string_view text() const { return trimmed(_text); }
    /// Of the present element, in begin().
    std::string attribute(const char* name) const;
    /// Of the present element's beginning or end.
    int line() const;
    [[noreturn]] void fail(int line, const std::string& sentence) const;

private:
    struct Faults;
    void takeNode();

    const std::string& _document;
    _xmlTextReader* _reader = nullptr;
    std::vector<std::string> _path;
    std::string _text;
    std::size_t _bytes = 0;
    bool _sawKml = false;
    std::string _fault;
    int _faultLine = 0;
};

} // namespace osgGeoFX
