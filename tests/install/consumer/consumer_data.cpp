// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/LandCoverTable.h>

#include <fstream>

int main()
{
    std::ofstream("table.csv") << "value,class,name,red,green,blue\n7,lake,Lake,10,20,30\n";
    const auto classes = osgGeoFX::readLandCoverTable("table.csv");
    return classes.size() == 1 && classes[0].value == 7 && classes[0].color[2] == 30 ? 0 : 1;
}
