// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <memory>
#include <string>

struct _xmlDoc; // libxml2's; NOLINT(bugprone-reserved-identifier)

namespace osgGeoFX
{

struct SldDocumentFreer
{
    void operator()(_xmlDoc* document) const;
};
/// A document of libxml2.
using SldDocument = std::unique_ptr<_xmlDoc, SldDocumentFreer>;

/// Reads an SLD file, without the network. Throws BuildError, with a sentence that names the file, where it cannot be read, has more
/// than 16 MiB, is packed, has a document type (so there are no entities), or is not XML. `what`: what people have in it, such as
/// "the style".
SldDocument readSldDocument(const std::string& file, const std::string& what);

} // namespace osgGeoFX
