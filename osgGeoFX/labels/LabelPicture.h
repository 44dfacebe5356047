// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/scene/DepthReader.h>

#include <osg/Camera>
#include <osg/Image>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The names of one finished picture, for programs that write images. Live pictures have MapLabels.

    It places the names once. They can be drawn onto the picture; PictureVectors writes them as vectors that lie where the picture
    has them.
    @ingroup labels */
class OSGGEOFXMAPS_EXPORT LabelPicture
{
public:
    struct Name
    {
        std::size_t name = 0;          ///< its index in the set
        PlacedLabel label;             ///< pixels, y upwards
        std::vector<osg::Vec2d> curve; ///< of a name along a curve; pixels, y upwards
    };

    /// `camera`: of the whole picture, with its viewport. `depths`: of the frame, from the cameras that drew the picture or its
    /// parts (DepthReader::pictures()); what they show to be hidden gets no name. Empty: nothing counts as hidden. Names keep off ways on a globe (RouteMapping)
    /// where there is room.
    LabelPicture(NameSet& names, EffectScene& scene, const osg::Camera& camera,
                 const std::vector<std::shared_ptr<const DepthPicture>>& depths,
                 const LabelLayout::Rules& rules = {}, std::size_t most = usualMost);
    /// The same for names that NameSet::inPicture() has found in a picture of this size. `visible` tells which of them are to be seen, one
    /// for each.
    LabelPicture(NameSet& names, const std::vector<NameSet::Seen>& seen, const std::vector<bool>& visible,
                 double width, double height, const LabelLayout::Rules& rules = {});
    /// Names that are looked at in a picture.
    static constexpr std::size_t usualMost = 2000;

    const std::vector<Name>& placed() const { return _placed; }

    /// Draws lines and names to Cairo, in the picture's pixels with y downwards.
    void draw(_cairo* target) const;
    /// Draws them onto an image of the picture's size with 8 or 16 bits for each of three or four channels. False if the image is another
    /// one.
    bool drawOnto(osg::Image& image) const;
    /// Draws them onto some rows of the picture, an image as wide as the picture. `top`: the row of the picture, counted from the uppermost
    /// one, that is the image's uppermost.
    bool drawOnto(osg::Image& rows, int top) const;
    /// The set, whose texts and styles the names have.
    NameSet& names() const { return *_names; }
    double width() const { return _width; }
    double height() const { return _height; }

private:
    void place(const std::vector<NameSet::Seen>& seen, const std::vector<bool>& visible,
               const LabelLayout::Rules& rules, const std::vector<LabelBand>& bands);

    osg::ref_ptr<NameSet> _names;
    double _width;
    double _height;
    std::vector<Name> _placed;
};

} // namespace osgGeoFX
