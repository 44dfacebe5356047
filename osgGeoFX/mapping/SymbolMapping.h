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

/** Map symbols that lie on the terrain (Trapp and Döllner 2009, Section 5 and Figure 3.E): any number of them, in metres or
    in pixels, fixed on the map or turned to the eye, and more abstract ones for those further off.

    @code
    const std::optional<int> peak = symbols->addLook({{{detailed, 8000.0}, {plain, 60000.0}}, 300.0});
    const std::optional<int> symbol = symbols->add(*peak, {x, y, height});
    @endcode
    A look is shared by its symbols, and so are the layers of its images. The images of a look follow each other with
    distance; the one fades in as the other fades out, so that together they are always as strong as one. A symbol is a
    mapping for each of its look's images.

    Places are those of the mappings' frame, metres. Symbols come and go between frames, by the thread of the frame loop; the
    destructor takes all away. */
class OSGGEOFX_EXPORT SymbolMapping : public osg::Referenced
{
public:
    explicit SymbolMapping(ProjectiveMappings& mappings);

    /// One image, out to so many metres from the eye.
    struct Level
    {
        osg::ref_ptr<DataLayer> layer;
        double farthest = 5e7;
    };
    /// The middle of the image lies at the symbol's place; a pin has its tip there.
    struct Look
    {
        std::vector<Level> levels; ///< the nearest first
        double width = 100.0;      ///< metres; of one in pixels the largest
        double pixels = 0.0;       ///< width on the screen; 0: metres count
        double stretch = 1.0;      ///< height over width; above 1 against the foreshortening of low views
        bool turned = false;       ///< upright to the eye, whatever the heading
        double nearest = 0.0;      ///< metres from the eye where the first image begins
        double softness = 0.2;     ///< share of a distance over which images go over, 0…1
        double opacity = 1.0;      ///< 0…1
        int order = 0;
    };
    /// The number of the look, for add(). Nothing, with a warning, where a level has no image or the next one would be gone
    /// before this one has faded out, and where numbers are out of range.
    std::optional<int> addLook(const Look& look);

    /// The number of the symbol; it is never used again. `place` with its height; heading in radians clockwise from the
    /// frame's y axis. Nothing, with a warning, where there is no such look or the place is out of range.
    std::optional<int> add(int look, const osg::Vec3d& place, double heading = 0.0);
    /// False where there is no such symbol; so below.
    bool move(int symbol, const osg::Vec3d& place, double heading = 0.0);
    bool setEnabled(int symbol, bool enabled);
    bool remove(int symbol);
    void clear();
    std::size_t size() const { return _symbols.size(); }
    /// The symbol that a mapping belongs to, for ProjectiveMappings::mappingsAt(); nothing where it is none.
    std::optional<int> symbolOf(const ProjectiveMapping& mapping) const;
    /// A symbol's mappings, one for each level of its look; none where there is no such symbol.
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
