// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>

namespace osgGeoFX
{

/// A file of osgGeoFX/web/page.
struct BakedFile
{
    const char* name;
    const char* content;
    std::size_t size;
};

extern const BakedFile bakedPage[];
extern const std::size_t bakedPageCount;

} // namespace osgGeoFX
