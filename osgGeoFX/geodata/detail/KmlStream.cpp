// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/KmlStream.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/KmlFolder.h>
#include <osgGeoFX/paging/ReadingFile.h>

#include <cpl_vsi.h>
#include <libxml/xmlreader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <memory>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t largestDocument = std::size_t{256} << 20;
constexpr std::size_t mostDepth = 256;

/// A file as libxml2 reads it.
struct Source
{
    VSILFILE* file = nullptr;
    std::size_t bytes = 0;
    bool tooLong = false;

    static int read(void* context, char* buffer, int length)
    {
        auto& source = *static_cast<Source*>(context);
        const std::size_t count = VSIFReadL(buffer, 1, static_cast<std::size_t>(length), source.file);
        source.bytes += count;
        source.tooLong = source.bytes > largestDocument;
        return source.tooLong ? -1 : static_cast<int>(count);
    }
    static int close(void*) { return 0; }
};

struct FileCloser
{
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
struct ReaderCloser
{
    void operator()(xmlTextReader* reader) const { xmlFreeTextReader(reader); }
};

} // namespace

std::string_view trimmed(std::string_view text)
{
    const char* const space = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(space);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(space) + 1 - begin);
}

std::optional<double> numberOf(std::string_view text)
{
    text = trimmed(text);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

bool isKmlFeature(const std::string& name)
{
    // Also those that are not read: what they say of themselves is not their folder's.
    static const char* const features[] = {"Document",     "Folder",    "GroundOverlay",
                                           "NetworkLink",  "Placemark", "ScreenOverlay",
                                           "PhotoOverlay", "Model",     "Tour"};
    return std::find(std::begin(features), std::end(features), name) != std::end(features);
}

/// What libxml2 calls with each of them; the first one counts.
struct KmlStream::Faults
{
    static void note(void* context, xmlErrorPtr error)
    {
        auto& self = *static_cast<KmlStream*>(context);
        if (!self._fault.empty() || !error || error->level < XML_ERR_ERROR) return;
        self._fault = error->message ? std::string(trimmed(error->message)) : "unknown fault";
        self._faultLine = error->line;
    }
};

void KmlStream::parse()
{
    const std::string name = KmlFolder::plain(_document);
    const std::unique_ptr<VSILFILE, FileCloser> file(VSIFOpenL(_document.c_str(), "rb"));
    if (!file) throw BuildError(name + ": the file cannot be read; check its name and rights.");
    const ReadingFile reading(name);
    Source source;
    source.file = file.get();
    const std::unique_ptr<xmlTextReader, ReaderCloser> reader(
        xmlReaderForIO(&Source::read, &Source::close, &source, nullptr, nullptr,
                       // A way's coordinates may have more than the 10 MB of libxml2's own limit.
                       XML_PARSE_NONET | XML_PARSE_BIG_LINES | XML_PARSE_HUGE));
    if (!reader) throw BuildError(name + ": there is no memory to read it; free some.");
    _reader = reader.get();
    xmlTextReaderSetStructuredErrorHandler(_reader, &Faults::note, this);
    int status = 0;
    while ((status = xmlTextReaderRead(_reader)) == 1)
        takeNode();
    if (source.tooLong) throw BuildError(name + ": it has more than 256 MiB; split it.");
    if (status != 0 || !_sawKml)
        throw BuildError(name + (_faultLine > 0 ? ":" + std::to_string(_faultLine) : "") +
                         ": it is not KML (" + (_fault.empty() ? "no element <kml>" : _fault) +
                         "); save or export it again.");
    _bytes = source.bytes;
}

int KmlStream::line() const
{
    // The parser itself is some hundred bytes ahead.
    return static_cast<int>(xmlGetLineNo(xmlTextReaderCurrentNode(_reader)));
}

void KmlStream::fail(int line, const std::string& sentence) const
{
    // A document type has no line.
    throw BuildError(KmlFolder::plain(_document) + (line > 0 ? ":" + std::to_string(line) : "") + ": " +
                     sentence);
}

bool KmlStream::isAt(std::initializer_list<const char*> names) const
{
    if (_path.size() < names.size()) return false;
    return std::equal(names.begin(), names.end(), _path.end() - static_cast<std::ptrdiff_t>(names.size()));
}

const std::string& KmlStream::parent() const
{
    static const std::string none;
    return _path.size() > 1 ? _path[_path.size() - 2] : none;
}

const std::string& KmlStream::grandparent() const
{
    static const std::string none;
    return _path.size() > 2 ? _path[_path.size() - 3] : none;
}

std::string KmlStream::attribute(const char* name) const
{
    xmlChar* const text = xmlTextReaderGetAttribute(_reader, reinterpret_cast<const xmlChar*>(name));
    if (!text) return {};
    std::string value = reinterpret_cast<const char*>(text);
    xmlFree(text);
    return value;
}

void KmlStream::takeNode()
{
    const auto close = [this]
    {
        end();
        _path.pop_back();
        _text.clear();
    };
    switch (xmlTextReaderNodeType(_reader))
    {
    case XML_READER_TYPE_DOCUMENT_TYPE:
        fail(line(), "it is not KML (it has a document type, which may define entities); save it without.");
    case XML_READER_TYPE_ELEMENT:
    {
        if (_path.size() >= mostDepth)
            fail(line(), "it is not KML (its elements are more than 256 deep); save or export it again.");
        const bool isEmpty = xmlTextReaderIsEmptyElement(_reader) == 1;
        _path.emplace_back(reinterpret_cast<const char*>(xmlTextReaderConstLocalName(_reader)));
        _text.clear();
        if (_path.back() == "kml" || (_path.size() == 1 && isKmlFeature(_path.back()))) _sawKml = true;
        begin();
        if (isEmpty) close();
        break;
    }
    case XML_READER_TYPE_TEXT:
    case XML_READER_TYPE_CDATA:
        if (const xmlChar* const value = xmlTextReaderConstValue(_reader))
        {
            const std::size_t most = longestText();
            const std::string_view part(reinterpret_cast<const char*>(value));
            _text.append(part.substr(0, most - std::min(most, _text.size())));
        }
        break;
    case XML_READER_TYPE_END_ELEMENT:
        close();
        break;
    default:
        break;
    }
}

} // namespace osgGeoFX
