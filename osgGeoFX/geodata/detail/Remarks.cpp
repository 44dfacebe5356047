// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/Remarks.h>

#include <osg/Notify>

#include <mutex>
#include <set>

namespace osgGeoFX
{

void remarkOnce(const std::string& sentence)
{
    static std::mutex mutex;
    static std::set<std::string> printed;
    const std::lock_guard<std::mutex> lock(mutex);
    if (printed.insert(sentence).second) OSG_WARN << "osgGeoFX: " << sentence << std::endl;
}

} // namespace osgGeoFX
