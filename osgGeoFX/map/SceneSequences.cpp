// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SceneSequences.h>

#include <osgGeoFX/map/SequenceFile.h>
#include <osgGeoFX/map/detail/SceneCrs.h>
#include <osgGeoFX/mapping/LayerWords.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

void setColors(ProjectiveMapping& mapping, const SequenceFile& file)
{
    if (file.steps->kind() == DataLayer::COLOR) return;
    constexpr double most = 9e7; // ColorTransfer's
    double low = std::clamp(file.lowest, -most, most), high = std::clamp(file.highest, -most, most);
    if (!(low < high)) high = low + 1.0;
    osg::ref_ptr<ColorTable> table = file.table;
    if (!table) table = ColorTable::named("viridis", low, high);
    std::tie(low, high) = table->range();
    mapping.setTable(table);
    mapping.getTransfer()->setSource(ColorTransfer::TABLE);
    mapping.getTransfer()->setValueRange(std::clamp(low, -most, most), std::clamp(high, -most, most));
}

} // namespace

SceneSequences::SceneSequences(osg::Node& node, EffectScene& scene)
    : _scene(&scene), _player(LayerPlayer::onto(scene))
{
    if (!scene.ground().ellipsoid) _wkt = crsOfScene(node);
}

bool SceneSequences::add(const std::string& file, const Options& options, std::string& error)
{
    SequenceFile request;
    request.file = file;
    request.colors = options.colors;
    request.maxSide = options.maxSide;
    request.bands = options.bands;
    request.globe = _scene->ground().ellipsoid.valid();
    request.wkt = _wkt;
    if (!request.read(error)) return false;

    std::vector<SequenceFile::Part> parts = request.others;
    parts.insert(parts.begin(), {request.origin, request.steps, request.low, request.high});
    std::vector<std::pair<osg::ref_ptr<ProjectiveMappings>, osg::ref_ptr<LayerSequence>>> made;
    for (const SequenceFile::Part& part : parts)
    {
        const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(part.steps);
        const std::string fault = _player->faultOf(*sequence);
        if (!fault.empty())
        {
            error = file + ": " + fault;
            return false;
        }
        const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        const osg::Vec2d half = (part.high - part.low) / 2.0;
        if (!mapping->setRectangle(part.low + half, half.x(), half.y()))
        {
            error = file + ": it covers no area on the ground; check it with gdalinfo.";
            return false;
        }
        mapping->setName(request.variable.empty() ? file : request.variable);
        LayerWords::setUnit(*sequence->getLayer(), request.unit);
        mapping->setLayer(sequence->getLayer());
        mapping->setOpacity(options.opacity);
        setColors(*mapping, request);
        const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
        effect->setName("sequence");
        effect->setLocalOrigin(part.origin);
        effect->addMapping(mapping);
        made.emplace_back(effect, sequence);
    }
    for (const auto& [effect, sequence] : made)
    {
        _scene->addEffect(effect);
        _player->add(sequence, LayerPlayer::usualTime);
        sequence->update();
    }
    return true;
}

} // namespace osgGeoFX
