// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrapper of the roads, rivers and towns of panorama maps.
#include "Wrappers.h"

#include <osgGeoFX/panorama/StrokeLines.h>

#include <osg/Notify>

namespace osgGeoFX
{

namespace
{

constexpr const char* className = "StrokeLines";

bool hasLines(const StrokeLines& lines)
{
    return !lines.getLines().empty();
}

/// The units and the number of lines; of each line its kind, the number of its points, and their numbers.
bool writeLines(osgDB::OutputStream& stream, const StrokeLines& lines)
{
    stream << static_cast<unsigned int>(lines.getUnits());
    stream << static_cast<unsigned int>(lines.getLines().size()) << stream.BEGIN_BRACKET << std::endl;
    for (const StrokeLines::Line& line : lines.getLines())
    {
        stream << static_cast<unsigned int>(line.kind) << static_cast<unsigned int>(line.points.size());
        for (const osg::Vec2d& point : line.points)
            stream << exactText(point.x()) << exactText(point.y());
        stream << std::endl;
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

bool readLines(osgDB::InputStream& stream, StrokeLines& lines)
{
    unsigned int units = 0, count = 0;
    stream >> units >> count >> stream.BEGIN_BRACKET;
    std::vector<StrokeLines::Line> all;
    bool right = units <= StrokeLines::METRES;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        unsigned int kind = 0, points = 0;
        stream >> kind >> points;
        right = right && kind <= StrokeLines::TOWN;
        StrokeLines::Line line;
        line.kind = static_cast<StrokeLines::Kind>(kind);
        for (unsigned int j = 0; j < points && !stream.getException(); ++j)
        {
            const double x = readNumber(stream, className);
            line.points.emplace_back(x, readNumber(stream, className));
        }
        all.push_back(std::move(line));
    }
    stream >> stream.END_BRACKET;
    if (stream.getException()) return false;
    if (!right || !lines.set(static_cast<StrokeLines::Units>(units), std::move(all)))
        OSG_WARN
            << "osgGeoFX: A file is wrong: StrokeLines: each of the Lines needs a kind of 0 to 2 and two "
               "places at least. There are none."
            << std::endl;
    return true;
}

void addLines(const char*, osgDB::ObjectWrapper* wrapper)
{
    addOwn<StrokeLines>(*wrapper, "Lines", &hasLines, &readLines, &writeLines);
}

const osgDB::RegisterCustomWrapperProxy wrapper([]() -> osg::Object* { return new StrokeLines; },
                                                serializerDomain, "osgGeoFX::StrokeLines",
                                                "osg::Object osgGeoFX::StrokeLines", &addLines);

} // namespace

} // namespace osgGeoFX
