// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The limit that the documents of a KML file share.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/KmlLineReader.h>
#include <tools/KmlFiles.h>
#include <tools/TempDir.h>

using namespace osgGeoFX;
using namespace geofx::test;

TEST(KmlLineReader, placesOfLinesCountAlsoWhereTheyAreOff)
{
    const TempDir folder;
    const std::string way = "<LineString><coordinates>7,45 8,46</coordinates></LineString>";
    const std::string text =
        kml("<Placemark>" + way + "</Placemark><Placemark><visibility>0</visibility>" + way + "</Placemark>");
    const std::string file = folder.write("doc.kml", text).string();
    const KmlLines lines = readKmlLines(file, 4);
    EXPECT_EQ(lines.routes.size(), 1u);
    EXPECT_EQ(lines.places, 4u);
    EXPECT_EQ(lines.bytes, text.size());
    EXPECT_THROW(readKmlLines(file, 3), BuildError);
}
