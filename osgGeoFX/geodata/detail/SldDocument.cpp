// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/SldDocument.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <libxml/parser.h>
#include <libxml/tree.h>

#include <cstdint>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

struct ParserFreer
{
    void operator()(xmlParserCtxt* parser) const { xmlFreeParserCtxt(parser); }
};

} // namespace

void SldDocumentFreer::operator()(xmlDoc* document) const
{
    xmlFreeDoc(document);
}

SldDocument readSldDocument(const std::string& file, const std::string& what)
{
    constexpr std::uintmax_t largest = 32u << 20;
    std::error_code fault;
    const std::uintmax_t size = std::filesystem::file_size(file, fault);
    if (fault || size > largest)
        throw BuildError(file + ": " + what + " cannot be read, or has more than 32 MiB; give an SLD file.");
    // No entities, no network, nothing on the terminal.
    const std::unique_ptr<xmlParserCtxt, ParserFreer> parser(xmlNewParserCtxt());
    SldDocument document(xmlCtxtReadFile(parser.get(), file.c_str(), nullptr,
                                         XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING));
    if (document) return document;
    std::string reason = parser->lastError.message ? parser->lastError.message : "unknown fault";
    reason.erase(reason.find_last_not_of(" \r\n") + 1);
    throw BuildError(file + ":" + std::to_string(parser->lastError.line) + ": it is not XML (" + reason +
                     "); export the style as SLD again.");
}

} // namespace osgGeoFX
