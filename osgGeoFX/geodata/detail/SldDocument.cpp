// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/SldDocument.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <libxml/parser.h>
#include <libxml/tree.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace osgGeoFX
{

namespace
{

struct ParserFreer
{
    void operator()(xmlParserCtxt* parser) const { xmlFreeParserCtxt(parser); }
};

/// libxml2 calls this before it reads what a document type declares.
void refuseType(void* context, const xmlChar*, const xmlChar*, const xmlChar*)
{
    auto* const parser = static_cast<xmlParserCtxt*>(context);
    *static_cast<bool*>(parser->_private) = true;
    xmlStopParser(parser);
}

} // namespace

void SldDocumentFreer::operator()(xmlDoc* document) const
{
    xmlFreeDoc(document);
}

SldDocument readSldDocument(const std::string& file, const std::string& what)
{
    constexpr std::uintmax_t largest = 16u << 20;
    std::error_code fault;
    const std::uintmax_t size = std::filesystem::file_size(file, fault);
    // The bytes of the file itself: libxml2 would unpack them.
    std::ifstream stream(file, std::ios::binary);
    if (fault || size > largest || !stream)
        throw BuildError(file + ": " + what + " cannot be read, or has more than 16 MiB; give an SLD file.");
    std::string text(static_cast<std::size_t>(size), '\0');
    stream.read(text.data(), static_cast<std::streamsize>(size));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.compare(0, 2, "\x1f\x8b") == 0)
        throw BuildError(file + ": it is packed by gzip; unpack it with gunzip.");
    // No network, nothing on the terminal.
    const std::unique_ptr<xmlParserCtxt, ParserFreer> parser(xmlNewParserCtxt());
    bool hasType = false;
    parser->_private = &hasType;
    parser->sax->internalSubset = &refuseType;
    SldDocument document(xmlCtxtReadMemory(parser.get(), text.data(), static_cast<int>(text.size()), nullptr,
                                           nullptr,
                                           XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING));
    if (hasType)
        throw BuildError(
            file + ": it has a document type (<!DOCTYPE>), which may define entities; save it without.");
    if (document) return document;
    std::string reason = parser->lastError.message ? parser->lastError.message : "unknown fault";
    reason.erase(reason.find_last_not_of(" \r\n") + 1);
    throw BuildError(file + ":" + std::to_string(parser->lastError.line) + ": it is not XML (" + reason +
                     "); export the style as SLD again.");
}

} // namespace osgGeoFX
