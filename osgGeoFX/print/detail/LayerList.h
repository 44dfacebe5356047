// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/// The layers of a picture and how they are put together: layers.json.
class LayerList
{
public:
    struct Layer
    {
        std::string name, file;
        std::vector<std::string> channels;
        std::string kind; ///< color, factor or value
        std::string type, unit, meaning;
    };

    /// `noReference`: why pixels have no longitude and latitude; empty where they have.
    LayerList(bool painted, bool water, bool strokes, const std::string& noReference);

    const std::deque<Layer>& layers() const { return _layers; }
    /// Null where the picture has no such layer.
    const Layer* find(const std::string& name) const;
    /// A layer of colors above all others.
    const Layer& addOverlay(const std::string& name, const std::string& meaning);
    void leaveOut(const std::string& name, const std::string& why);
    /// How oiiotool puts them together.
    std::string command() const;
    /// Throws LayerFault.
    void write(const std::filesystem::path& folder, int width, int height) const;

private:
    void addColor(const std::string& name, const std::string& meaning, bool opaque = false);

    std::deque<Layer> _layers; ///< colors from the lowest, and values
    std::vector<std::pair<std::string, std::string>> _leftOut;
    bool _painted;
};

} // namespace osgGeoFX
