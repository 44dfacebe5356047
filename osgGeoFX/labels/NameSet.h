// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/LabelLayout.h>
#include <osgGeoFX/labels/LabelText.h>
#include <osgGeoFX/labels/MapName.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/DepthReader.h>

#include <osg/BoundingSphere>
#include <osg/Referenced>
#include <osg/Vec4>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

class LiftedPlaces;

/// How names of one kind are drawn. A plain value.
/// @ingroup labels
struct NameStyle
{
    LabelStyle text;
    LabelCandidate::Manner manner =
        LabelCandidate::LEADER; ///< of names of one place; others follow their curve
    double lineWidth = 1.2;     ///< of the leader, and of the halo around it on each side; pixels
    double dot = 0.0;           ///< the radius of a dot at the place, pixels; 0: none
};

/** Styles for what OpenStreetMap and other maps name, by the words that they use: summits (peak, volcano, hill …) with a line, towns (city,
    town, village …) with a dot, and names along curves: water (lake, river, bay …) blue and inclined, ranges (ridge, valley, range …)
    with spaces. That of the empty name is a summit's.
    @ingroup labels */
OSGGEOFXMAPS_EXPORT std::map<std::string, NameStyle> usualNameStyles();

/** The names of a map and their styles.

    It finds the names of a picture, the most important ones first, without looking at all of a million. One thread at a time uses
    a set.
    @ingroup labels */
class OSGGEOFXMAPS_EXPORT NameSet : public osg::Referenced
{
public:
    /// Names without text, without a place, or with a place that is no number are left out. Names of equal importance stay in
    /// their order.
    explicit NameSet(std::vector<MapName> names = {});

    /// By falling importance.
    const std::vector<MapName>& names() const { return _names; }

    /// The style of the names that ask for it; the one of the empty name is for all others.
    void setStyle(const std::string& name, const NameStyle& style);
    const NameStyle& styleOf(const MapName& name) const;
    /// The styles that were set, by name.
    const std::map<std::string, NameStyle>& styles() const { return _styles; }
    /// The factor of all sizes, such as that of a print's resolution; > 0.
    void setScale(double scale);
    double getScale() const { return _scale; }

    /// In the context of a bend, beyond the middle of its transition zone, only landmarks keep their names: those of at least this importance. Less
    /// important names are found there, and are not visible. −∞, the default, keeps all; names of unknown importance are no landmarks.
    void setContextImportance(double least) { _contextImportance = least; }
    double getContextImportance() const { return _contextImportance; }

    /// A name in a picture.
    struct Seen
    {
        std::size_t name = 0; ///< its index in names()
        LabelCandidate label; ///< with the part of a name's curve that is as long as the text
        /// Where the name's places are drawn, world coordinates.
        std::vector<osg::Vec3d> drawn;
    };
    /** The names whose places lie in a camera's picture, `width` × `height` pixels, the most important ones first. Names of a region that a
        close-up shows are on the close-up. `most`: how many visible ones at most. All are taken to be visible but those that
        setContextImportance() leaves out. `time`: the simulation time, seconds, which moves close-ups. */
    std::vector<Seen> inPicture(EffectScene& scene, const osg::Matrixd& view, const osg::Matrixd& projection,
                                double width, double height, std::size_t most, double time = 0.0);
    /// How many of a name's places are to be seen in the pictures of a view's cameras, or of tiles.
    static std::size_t placesShown(const Seen& seen,
                                   const std::vector<std::shared_ptr<const DepthPicture>>& pictures);
    /// Whether a name with so many places in sight is shown: a name of one place with this one, a curve's with a third of the curve, for trees and ridges
    /// stand before parts of it.
    static bool isShown(const Seen& seen, std::size_t places) { return 3 * places >= seen.drawn.size(); }
    /// The laid out text of a name.
    const LabelText& text(std::size_t name);

protected:
    ~NameSet() override;

private:
    struct Branch
    {
        osg::BoundingSphered ball;       ///< of all places below
        std::size_t first = 0;           ///< the most important name below
        std::size_t left = 0, right = 0; ///< branches; both 0 for one that has names
        std::vector<std::size_t> names;
    };
    std::size_t grow(std::vector<std::size_t> names);
    bool see(std::size_t name, const DeformedView& view, const LiftedPlaces& lifted, double width,
             double height, Seen& seen);

    std::vector<MapName> _names;
    std::map<std::string, NameStyle> _styles;
    double _scale = 1.0;
    double _contextImportance = -HUGE_VAL;
    std::vector<Branch> _tree;
    std::unordered_map<std::size_t, std::unique_ptr<LabelText>> _texts;
};

} // namespace osgGeoFX
