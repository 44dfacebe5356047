// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>
#include <osgGeoFX/raster/LayerPixels.h>

#include <osg/NodeCallback>
#include <osg/Vec4>
#include <osgGA/GUIEventHandler>

namespace osgGeoFX
{

class EffectScene;

/** A lens that moves over the terrain (Trapp and Döllner 2009, Section 5, focus and context): within a soft outline with a
    rim it shows what another mapping would, or the scene in other colours.

    What the lens shows is a mapping of its own that the program places but does not add: its layer, table, transfer
    and place count. Its picture is cut out below the lens at each move (`side`² texels, which are uploaded); one
    without a layer (the scene's own colours through a matrix) costs nothing to move. Of lenses that overlap, the one with
    the higher order lies on top, of equal ones the later one.

    Places are those of the mappings' frame, metres. Changed between frames by the thread of the frame loop; the destructor
    takes all away. Setters that get what makes no sense return false, warn once and change nothing. */
class OSGGEOFX_EXPORT LensMapping : public osg::Referenced
{
public:
    explicit LensMapping(ProjectiveMappings& mappings, int order = 100);

    /// The layer's mapping: of the projector PLANE, with any transform. Of colours their alpha counts; values and
    /// classes are opaque. Null: only the rim is drawn.
    void setContent(ProjectiveMapping* content);
    ProjectiveMapping* getContent() { return _content.get(); }
    /// To be called after the content or its layer's picture changed.
    void refresh();

    bool setCentre(const osg::Vec2d& place);
    osg::Vec2d getCentre() const { return _centre; }
    /// Half of the width and height, metres, and where the upper edge points, radians clockwise from the frame's y axis.
    bool setSize(double halfWidth, double halfHeight, double heading = 0.0);
    bool setRadius(double metres) { return setSize(metres, metres); }
    double getHalfWidth() const { return _halfWidth; }
    double getHalfHeight() const { return _halfHeight; }
    double getHeading() const { return _heading; }
    /// All at once, so that the picture is cut out once.
    bool place(const osg::Vec2d& centre, double halfWidth, double halfHeight, double heading = 0.0);

    struct Style
    {
        bool round = true;     ///< or a rectangle
        double softness = 0.0; ///< share of the radius over which the content fades out, 0…1
        double rim = 0.02;     ///< width of the rim line as a share of the radius, 0…½
        osg::Vec4 rimColor = {1.0f, 1.0f, 1.0f, 0.95f};
        double shade = 0.06; ///< of a soft dark edge outside of the rim, 0…½
        double opacity = 1.0;
        int side = 256; ///< of the picture that is cut out, texels, 16…2048
    };
    bool setStyle(const Style& style);
    const Style& getStyle() const { return _style; }
    bool setOrder(int order);
    bool setEnabled(bool enabled);

    /// The two mappings of the lens: what it shows, and the rim above.
    ProjectiveMapping& inside() const { return *_inside; }
    ProjectiveMapping& rim() const { return *_rim; }

protected:
    ~LensMapping() override;

private:
    void draw();
    void cutOut();

    osg::ref_ptr<ProjectiveMappings> _host;
    osg::ref_ptr<ProjectiveMapping> _content, _inside, _rim;
    osg::ref_ptr<DataLayer> _mask, _rimLayer, _cut;
    osg::ref_ptr<ColorTransfer> _transfer;
    Style _style;
    osg::Vec2d _centre;
    double _halfWidth = 500.0, _halfHeight = 500.0, _heading = 0.0;
    std::optional<LayerPixels> _pixels; ///< of the content's layer
};

/** Leads a lens along under the mouse pointer, wherever the effects bend the ground; Ctrl and the wheel change its size.
    Serves one view. */
class OSGGEOFX_EXPORT LensFollowsPointer : public osgGA::GUIEventHandler
{
public:
    /// The lens' mappings must be an effect of this scene. Sizes are kept within these limits, metres.
    LensFollowsPointer(EffectScene& scene, ProjectiveMappings& mappings, LensMapping& lens,
                       double smallest = 50.0, double largest = 20000.0);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

protected:
    ~LensFollowsPointer() override;

private:
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<ProjectiveMappings> _mappings;
    osg::ref_ptr<LensMapping> _lens;
    double _smallest, _largest;
};

/** An update callback that keeps a lens over the node it is on, for instance a vehicle below the scene. */
class OSGGEOFX_EXPORT LensFollowsNode : public osg::NodeCallback
{
public:
    LensFollowsNode(EffectScene& scene, ProjectiveMappings& mappings, LensMapping& lens);

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~LensFollowsNode() override;

private:
    osg::observer_ptr<EffectScene> _scene; ///< the node may be below it
    osg::ref_ptr<ProjectiveMappings> _mappings;
    osg::ref_ptr<LensMapping> _lens;
};

} // namespace osgGeoFX
