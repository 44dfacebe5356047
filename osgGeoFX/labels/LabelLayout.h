// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Vec2d>

#include <cstddef>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/// A name that wants a place in a picture. Pixels, with y upwards.
/// @ingroup labels
struct LabelCandidate
{
    enum Manner
    {
        LEADER, ///< above the place, with a line down to it: summits
        BESIDE, ///< right beside the place: towns
        CURVE   ///< on the place itself, which is the middle of the box: ranges, lakes
    };

    std::size_t id = 0; ///< the same in every picture
    osg::Vec2d anchor;  ///< the place itself
    osg::Vec2d size;    ///< of the text's box
    Manner manner = LEADER;
    bool visible = true; ///< whether the place is to be seen
    /// Of CURVE: the curve, pixels; and the text's height. Only what the letters take is taken from other names, and not all of
    /// the box.
    std::vector<osg::Vec2d> curve;
    double thickness = 0.0;
};

/// A name in a picture. Pixels, with y upwards.
/// @ingroup labels
struct PlacedLabel
{
    std::size_t id = 0;
    osg::Vec2d anchor;
    osg::Vec2d corner; ///< the lower left corner of the text's box
    osg::Vec2d size;
    double alpha = 1.0; ///< 0…1
    /// Whether a line leads from the anchor up to the box. It is vertical.
    bool leader = false;
};

/// A line in a picture, such as a way, that names keep off where there is room. Pixels, with y upwards.
/// @ingroup labels
struct LabelBand
{
    osg::Vec2d from, to;
    double halfWidth = 0.0;
};

/** Places names in one view's pictures, one after the other, so that no two overlap and nothing jumps.

    Names come in the order of the candidates: the first one gets the best place. A name that is shown keeps its place beside
    its anchor, so it moves exactly as the ground does. Where it can no longer stay, it fades out, and another one fades in.
    A name that fades is not drawn over another one. Lines run over no name.

    One thread at a time.
    @ingroup labels */
class OSGGEOFXMAPS_EXPORT LabelLayout
{
public:
    struct Rules
    {
        double gap = 10.0; ///< from the anchor to the lowest box, pixels
        /// Around a box where no other one is put, pixels. One that is shown stays until half of it is gone.
        double room = 8.0;
        int rows = 8;           ///< how high a line may be, in boxes
        double fading = 0.25;   ///< seconds from nothing to all; 0: at once
        double patience = 0.15; ///< seconds that a name must be in sight, or hidden, before it comes or goes
        std::size_t most = 400; ///< names in a picture
    };

    LabelLayout() = default;
    explicit LabelLayout(const Rules& rules) : _rules(rules) {}

    void setRules(const Rules& rules) { _rules = rules; }
    const Rules& getRules() const { return _rules; }

    /// The names of the next picture, of `width` × `height` pixels, at a time in seconds, in the order of the candidates. A name
    /// that is no candidate any more fades out where it was.
    /// A name beside its place takes the first place that is off all `bands` when it comes, or else the first one.
    std::vector<PlacedLabel> place(const std::vector<LabelCandidate>& candidates, double width, double height,
                                   double time, const std::vector<LabelBand>& bands = {});
    /// The same for a single picture: nothing fades, and former pictures do not count.
    static std::vector<PlacedLabel> placeOnce(const std::vector<LabelCandidate>& candidates, double width,
                                              double height, const Rules& rules,
                                              const std::vector<LabelBand>& bands = {});
    /// Forgets all former pictures.
    void clear() { _shown.clear(); }

private:
    struct Shown
    {
        osg::Vec2d offset; ///< from the anchor to the box's corner
        LabelCandidate last;
        double alpha = 0.0;
        double seen = 0.0;   ///< seconds in sight
        double hidden = 0.0; ///< seconds out of sight
        bool placed = false;
        unsigned int picture = 0; ///< the last one that had it among the candidates
    };

    Rules _rules;
    std::unordered_map<std::size_t, Shown> _shown;
    double _time = -1.0;
    unsigned int _picture = 0;
};

} // namespace osgGeoFX
