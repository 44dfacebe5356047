// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osg/Vec3d>

#include <map>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** Draws map symbols that lie on the terrain (Trapp and Döllner 2009, Section 5 and Figure 3.E). Any number of symbols
    is possible. Their size is in metres or in pixels. They are fixed on the map or turned towards the eye. Distant
    symbols may have a more abstract image.

    @code
    const std::optional<int> peak = symbols->addLook({{{detailed, 8000.0}, {plain, 60000.0}}, 300.0});
    const std::optional<int> symbol = symbols->add(*peak, {x, y, height});
    @endcode

    All symbols of a look share it and the layers of its images. The images of a look follow each other with distance.
    One image fades in while the former one fades out, so that their sum stays constant. A symbol has one mapping for
    each image of its look.

    Places are in the mappings' frame, metres. The thread of the frame loop adds and removes symbols, between frames.
    The destructor removes all of them.
    @ingroup mapping */
class OSGGEOFX_EXPORT SymbolMapping : public osg::Referenced
{
public:
    explicit SymbolMapping(ProjectiveMappings& mappings);

    /// One image, and the distance from the eye up to which it shows, metres, at most 5e7.
    struct Level
    {
        osg::ref_ptr<DataLayer> layer;
        double farthest = 5e7;
    };
    /// The appearance of symbols. The middle of the image lies at the symbol's place. The image of a pin therefore has
    /// the pin's tip in its middle.
    struct Look
    {
        std::vector<Level> levels; ///< images, the nearest first
        double width = 100.0;      ///< metres, 0.001…1e7; with `pixels` the largest width
        double pixels = 0.0;       ///< width on the screen, 0…1e5; 0: the width is in metres
        double stretch = 1.0;  ///< height over width, 0.01…100; above 1 offsets low views' foreshortening
        bool turned = false;   ///< upright towards the eye, whatever the heading
        double nearest = 0.0;  ///< distance from the eye where the first image begins, metres
        double softness = 0.2; ///< share of a distance over which one image replaces another, 0…1
        double opacity = 1.0;  ///< 0…1
        int order = 0;         ///< −1000…1000
    };
    /// Returns the number of the look, for add(). The result is empty, with a warning, if a level has no image, if a
    /// level ends before the former level has faded out, or if a number is out of range.
    std::optional<int> addLook(const Look& look);

    /// Returns the number of the symbol, which is never used again. `place` includes the height, metres. `heading` is
    /// in radians clockwise from the frame's y axis. The result is empty, with a warning, if the look does not exist
    /// or if the place is out of range (x and y ±5e7, height −12 000…1e7).
    std::optional<int> add(int look, const osg::Vec3d& place, double heading = 0.0);
    /// Returns false if the symbol does not exist or if the place is out of range.
    bool move(int symbol, const osg::Vec3d& place, double heading = 0.0);
    /// Returns false if the symbol does not exist.
    bool setEnabled(int symbol, bool enabled);
    /// Returns false if the symbol does not exist.
    bool remove(int symbol);
    void clear();
    std::size_t size() const { return _symbols.size(); }
    /// The symbol to which a mapping belongs. Use it with ProjectiveMappings::mappingsAt(). Empty for other mappings.
    std::optional<int> symbolOf(const ProjectiveMapping& mapping) const;
    /// The mappings of a symbol, one for each level of its look. Empty if the symbol does not exist.
    std::vector<ProjectiveMapping*> mappings(int symbol) const;

protected:
    ~SymbolMapping() override;

private:
    struct Symbol
    {
        int look = 0;
        std::vector<osg::ref_ptr<ProjectiveMapping>> mappings;
    };
    bool put(const Symbol& symbol, const osg::Vec3d& place, double heading) const;
    void take(const Symbol& symbol);

    osg::ref_ptr<ProjectiveMappings> _host;
    osg::ref_ptr<ColorTransfer> _transfer; ///< of all
    std::vector<Look> _looks;
    std::map<int, Symbol> _symbols;
    int _next = 0;
};

} // namespace osgGeoFX
