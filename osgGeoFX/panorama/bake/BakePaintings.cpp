// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// BakePaintings FOLDER: paints the usual sky and brush texture of panorama maps, and writes their texels into a folder. The kit's
// build calls it.
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace
{

bool write(const std::string& file, const osg::Image& image)
{
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(image.data()),
                 static_cast<std::streamsize>(image.getTotalSizeInBytes()));
    return static_cast<bool>(stream.flush());
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    const std::string folder = argv[1];
    using Usual = osgGeoFX::UsualPaintings;
    const bool written = write(folder + "/sky.rgba", *osgGeoFX::paintSky(Usual::SKY_WIDTH, Usual::SKY_HEIGHT,
                                                                         Usual::SEED, Usual::SEASON)) &&
                         write(folder + "/brush.rgba", *osgGeoFX::paintBrush(Usual::BRUSH_SIDE));
    if (!written) std::fprintf(stderr, "%s: the paintings cannot be written.\n", folder.c_str());
    return written ? 0 : 1;
}
