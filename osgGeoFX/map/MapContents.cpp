// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/MapContents.h>

#include <osgGeoFX/map/detail/MapNodes.h>

#include <osg/Group>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <locale>
#include <sstream>

namespace osgGeoFX
{

namespace
{

void takeOut(osg::Node& node)
{
    while (node.getNumParents() > 0)
        node.getParent(0)->removeChild(&node);
}

void write(std::ostream& stream, const osg::Vec4& color)
{
    stream << color.r() << ' ' << color.g() << ' ' << color.b() << ' ' << color.a() << ' ';
}

void write(std::ostream& stream, const std::string& name, const NameStyle& style)
{
    const LabelStyle& text = style.text;
    stream << name << '|' << text.font << '|' << text.size << ' ' << text.bold << ' ' << text.italic << ' '
           << text.spacing << ' ' << text.haloWidth << ' ' << text.longest << ' ' << style.manner << ' '
           << style.lineWidth << ' ' << style.dot << ' ';
    write(stream, text.color);
    write(stream, text.halo);
}

void write(std::ostream& stream, const std::string& name, const LineStyle& style)
{
    stream << name << '|' << style.width << ' ' << style.least << ' ' << style.ground << ' '
           << style.casingWidth << ' ' << style.dash << ' ' << style.gap << ' ' << style.hand << ' '
           << style.rank << ' ' << style.straight << ' ' << style.shown << ' ';
    write(stream, style.color);
    write(stream, style.casing);
}

void write(std::ostream& stream, const std::vector<osg::Vec3d>& places)
{
    for (const osg::Vec3d& place : places)
        stream << place.x() << ' ' << place.y() << ' ' << place.z() << ' ';
    stream << '\n';
}

} // namespace

MapContents MapContents::take(osg::Node& node)
{
    MapNodes nodes;
    node.accept(nodes);
    MapContents contents;
    for (const osg::ref_ptr<MapLabels>& labels : nodes.names)
    {
        takeOut(*labels);
        const NameSet* const set = labels->getNames();
        if (!set) continue;
        std::copy(set->names().begin(), set->names().end(), std::back_inserter(contents.names));
        for (const auto& [name, style] : set->styles())
            contents.styles.names[name] = style;
        contents.styles.contextImportance = set->getContextImportance();
    }
    for (const osg::ref_ptr<MapLines>& lines : nodes.lines)
    {
        takeOut(*lines);
        std::copy(lines->lines().begin(), lines->lines().end(), std::back_inserter(contents.lines));
        for (const auto& [name, style] : lines->styles())
            contents.styles.lines[name] = style;
    }
    return contents;
}

osg::ref_ptr<NameSet> MapContents::makeNames() const
{
    if (names.empty()) return nullptr;
    osg::ref_ptr<NameSet> set = new NameSet(names);
    for (const auto& [name, style] : styles.names)
        set->setStyle(name, style);
    set->setContextImportance(styles.contextImportance);
    return set;
}

void MapContents::addLinesTo(EffectScene& scene, double scale) const
{
    if (lines.empty()) return;
    const osg::ref_ptr<MapLines> node = new MapLines(lines, styles.lines);
    node->setScale(scale);
    scene.addChild(node);
}

osg::ref_ptr<osg::Node> MapContents::addTo(EffectScene& scene, osg::Node& node) const
{
    addLinesTo(scene);
    if (names.empty()) return &node;
    osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(&node);
    both->addChild(new MapLabels(scene, makeNames()));
    return both;
}

std::string MapContents::digest() const
{
    if (empty()) return {};
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(17);
    for (const MapName& name : names)
    {
        stream << name.text << '|' << name.kind << '|' << name.importance << '|' << name.style << '|';
        write(stream, name.places);
    }
    for (const MapLine& line : lines)
    {
        stream << line.name << '|' << line.style << '|';
        write(stream, line.places);
    }
    for (const auto& [name, style] : styles.names)
        write(stream, name, style);
    for (const auto& [name, style] : styles.lines)
        write(stream, name, style);
    if (styles.contextImportance > -HUGE_VAL) stream << '|' << styles.contextImportance;
    // FNV-1a.
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char each : stream.str())
        hash = (hash ^ static_cast<unsigned char>(each)) * 0x100000001b3u;
    return std::to_string(hash);
}

} // namespace osgGeoFX
