// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <stdexcept>

namespace osgGeoFX
{

/// Thrown for input that cannot be used or output that cannot be written. The message is a sentence that names the
/// file, if there is one, and the remedy.
/// @ingroup geodata
class OSGGEOFXDATA_EXPORT BuildError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    BuildError(const BuildError&) = default;
    ~BuildError() override;
};

} // namespace osgGeoFX
