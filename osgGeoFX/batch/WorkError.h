// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <stdexcept>

namespace osgGeoFX
{

/// Thrown for plans that cannot be used and files that cannot be written. The message is a sentence that names the
/// file, if there is one, and the remedy.
/// @ingroup batch
class OSGGEOFX_EXPORT WorkError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    WorkError(const WorkError&) = default;
    ~WorkError() override;
};

} // namespace osgGeoFX
