// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/GlFixture.h>
#include <tools/PanoramaHills.h>
#include <tools/TempDir.h>

#include <osg/Material>

#include <filesystem>
#include <string>
#include <vector>

namespace geofx::test
{

/// Finished pictures of the hills of tests, with names.
class HillsPicture : public GlFixture
{
protected:
    HillsPicture(int width, int height) : _width(width), _height(height) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _up = _hills.middle();
        _up.normalize();
        _east = osg::Vec3d(0.0, 0.0, 1.0) ^ _up;
        _east.normalize();
        _north = _up ^ _east;
        _view = osg::Matrixd::lookAt(_hills.middle() + _up * 9000.0 - _north * 16000.0, _hills.middle(), _up);
        _drawing.fieldOfView = 40.0;
        _drawing.width = _width;
        _drawing.height = _height;
    }

    /// A name above all hills, so many metres from their middle.
    void addName(double east, double north)
    {
        osgGeoFX::MapName name;
        name.text = "Name " + std::to_string(_names.size());
        name.importance = 60.0 - static_cast<double>(_names.size());
        name.places = {_hills.middle() + _east * east + _north * north + _up * 1700.0};
        _names.push_back(name);
    }
    osg::ref_ptr<osgGeoFX::NameSet> names() const
    {
        osg::ref_ptr<osgGeoFX::NameSet> result = new osgGeoFX::NameSet(_names);
        osgGeoFX::NameStyle style;
        style.text.size = 9.0;
        style.text.font = "DejaVu Sans";
        result->setStyle("", style);
        return result;
    }

    /// The hills with an effect; a scene of its own each time.
    virtual osgGeoFX::Scene scene(osgGeoFX::Effect* effect) const
    {
        std::string error;
        const osg::ref_ptr<osg::Node> terrain = _hills.terrain();
        // Without one OSG takes the color of whatever was drawn last.
        terrain->getOrCreateStateSet()->setAttributeAndModes(new osg::Material);
        std::optional<osgGeoFX::Scene> result = osgGeoFX::Scene::adopt(terrain, error);
        EXPECT_TRUE(result) << error;
        if (effect) result->effects->addEffect(effect);
        return *result;
    }
    /// The picture at once, names and all.
    osg::ref_ptr<osg::Image> atOnce(osgGeoFX::Effect* effect,
                                    const osg::ref_ptr<osgGeoFX::NameSet>& set) const
    {
        osgGeoFX::Scene whole = scene(effect);
        const osg::ref_ptr<osgGeoFX::DepthReader> reader = whole.readDepths();
        std::string error;
        const auto renderer = osgGeoFX::SceneRenderer::create(whole, _drawing, error);
        EXPECT_TRUE(renderer) << error;
        osgGeoFX::FrameStatistics unused;
        osg::ref_ptr<osg::Image> image = renderer->render(_view, 0.0, unused, error);
        EXPECT_TRUE(image) << error;
        if (set)
            osgGeoFX::LabelPicture(*set, *whole.effects, renderer->camera(), reader->pictures())
                .drawOnto(*image);
        return image;
    }
    std::string file(const std::string& name) const
    {
        return (std::filesystem::path(_folder.path()) / name).string();
    }

    TempDir _folder;
    const PanoramaHills _hills{0.65};
    osg::Vec3d _up, _east, _north; ///< at the hills' middle
    osg::Matrixd _view;
    osgGeoFX::SceneRenderer::Options _drawing;
    std::vector<osgGeoFX::MapName> _names;

private:
    const int _width, _height;
};

} // namespace geofx::test
