// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/KmlOverlays.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/KmlFolder.h>
#include <osgGeoFX/geodata/detail/KmlReader.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t mostOverlays = 10000;
constexpr std::size_t mostFiles = 10000;
constexpr std::size_t mostNotices = 20;
constexpr std::size_t mostBytes = std::size_t{1} << 30;

const char* const remedy =
    "put it beside the KML file or below; or, if you trust the file, start the program with "
    "--allow-outside.";

/// Nothing is to be shown, and lines, areas and points may be.
class NoOverlays : public BuildError
{
public:
    using BuildError::BuildError;
};

/// A document and all that it links, the coarse ones first.
class Collector
{
public:
    Collector(const std::string& file, bool allowOutside, std::vector<std::string>& notices)
        : _file(file), _folder(file, allowOutside), _notices(notices)
    {
        add(_folder.document(), {});
    }

    std::vector<KmlOverlay> collect()
    {
        // take() adds to the queue.
        // NOLINTNEXTLINE(modernize-loop-convert)
        for (std::size_t next = 0; next < _queue.size(); ++next)
        {
            const Link link = _queue[next];
            take(link);
            if (_found.size() > mostOverlays)
                throw BuildError(_file + ": it has more than " + std::to_string(mostOverlays) +
                                 " ground overlays; split it, or make one raster of them with gdalbuildvrt.");
        }
        if (_found.empty() && !_firstFault.empty()) throw NoOverlays(_firstFault);
        if (_found.empty())
            throw NoOverlays(_file +
                             ": it has no ground overlays; its lines are read with --route or --lines, its "
                             "points with --labels.");
        showEarliest();
        std::stable_sort(_found.begin(), _found.end(),
                         [](const KmlOverlay& a, const KmlOverlay& b) { return a.order < b.order; });
        return std::move(_found);
    }

    const std::set<std::string>& documents() const { return _seen; }

private:
    struct Link
    {
        std::string document;
        KmlReader::Inherited inherited;
    };

    void add(const std::string& document, const KmlReader::Inherited& inherited)
    {
        // Pyramids may link back.
        if (!_seen.insert(document).second) return;
        if (_seen.size() > mostFiles)
            throw BuildError(_file + ": it links more than " + std::to_string(mostFiles) +
                             " files; open one of its parts instead.");
        _queue.push_back({document, inherited});
    }

    /// Empty, with a notice, where it leads out of the folder or to nothing.
    std::string resolved(const std::string& document, const std::string& href, int line)
    {
        const std::string name =
            KmlFolder::plain(document) + ":" + std::to_string(line) + ": \"" + href + "\"";
        const std::optional<std::string> path = _folder.resolve(document, href);
        VSIStatBufL status;
        if (!path)
            leaveOut(name + " leads out of the folder of " + _file + ", and is left out; " + remedy);
        else if (path->empty())
            leaveOut(name +
                     " is no picture and no KML, and is left out; name a PNG, JPEG, GIF, TIFF, BMP, WebP or "
                     "JPEG 2000.");
        else if (path->rfind("/vsicurl/", 0) != 0 && VSIStatL(path->c_str(), &status) != 0)
            leaveOut(name + " is not there, and is left out; put it there, or correct the name.");
        else
            return *path;
        return {};
    }

    void leaveOut(const std::string& sentence)
    {
        if (_firstFault.empty()) _firstFault = sentence;
        if (++_leftOut > mostNotices) return;
        _notices.push_back(sentence +
                           (_leftOut == mostNotices ? " So are others, which are not named." : ""));
    }

    /// Pictures of one place at different times would hide each other.
    void showEarliest()
    {
        std::string first;
        for (const KmlOverlay& each : _found)
        {
            const std::string& time = each.begin.empty() ? each.end : each.begin;
            if (!time.empty() && (first.empty() || time < first)) first = time;
        }
        std::size_t later = 0;
        for (KmlOverlay& each : _found)
        {
            // "2026" reaches to its last second.
            const bool isThere =
                each.begin <= first && (each.end.empty() || first.substr(0, each.end.size()) <= each.end);
            if (first.empty() || isThere || !each.visible) continue;
            each.visible = false;
            ++later;
        }
        if (later > 0)
            _notices.push_back(_file + ": of its ground overlays with times those of " + first +
                               " are shown; " + std::to_string(later) + " of other times are switched off.");
    }

    void take(const Link& link)
    {
        const KmlReader::Content content = KmlReader::read(link.document, link.inherited);
        _bytes += content.bytes;
        if (_bytes > mostBytes)
            throw BuildError(_file +
                             ": it and the files that it links have more than 1 GiB; open one of its parts "
                             "instead.");
        for (KmlReader::Overlay overlay : content.overlays)
        {
            if (!overlay.href.empty())
            {
                overlay.overlay.image = resolved(link.document, overlay.href, overlay.line);
                // No picture at all means a plain color.
                if (overlay.overlay.image.empty()) continue;
            }
            if (overlay.inAir && !_toldOfAir)
            {
                _toldOfAir = true;
                _notices.push_back(
                    KmlFolder::plain(link.document) + ":" + std::to_string(overlay.line) +
                    ": the ground overlay has an altitude, and is shown on the ground. So are others.");
            }
            _found.push_back(std::move(overlay.overlay));
        }
        for (const KmlReader::Link& next : content.links)
        {
            const std::string document = resolved(link.document, next.href, next.line);
            if (!document.empty()) add(document, next.inherited);
        }
    }

    const std::string& _file;
    const KmlFolder _folder;
    std::vector<std::string>& _notices;
    std::vector<Link> _queue;
    std::set<std::string> _seen;
    std::vector<KmlOverlay> _found;
    std::size_t _bytes = 0;
    std::size_t _leftOut = 0;
    std::string _firstFault; ///< of what is left out
    bool _toldOfAir = false;
};

} // namespace

bool KmlOverlays::read(const std::string& file, bool allowOutside, std::vector<KmlOverlay>& overlays,
                       std::vector<std::string>& notices, std::string& error, std::vector<std::string>* files,
                       bool* isNone)
{
    initialiseGdal();
    if (isNone) *isNone = false;
    try
    {
        Collector collector(file, allowOutside, notices);
        std::vector<KmlOverlay> found = collector.collect();
        if (files)
        {
            std::set<std::string> all;
            for (const std::string& document : collector.documents())
                all.insert(KmlFolder::onDisk(document));
            for (const KmlOverlay& overlay : found)
                all.insert(KmlFolder::onDisk(overlay.image));
            all.erase("");
            files->insert(files->end(), all.begin(), all.end());
        }
        overlays.insert(overlays.end(), std::make_move_iterator(found.begin()),
                        std::make_move_iterator(found.end()));
        return true;
    }
    catch (const NoOverlays& failure)
    {
        error = failure.what();
        if (isNone) *isNone = true;
        return false;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

bool KmlOverlays::isKml(const std::string& file)
{
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".kml" || extension == ".kmz";
}

} // namespace osgGeoFX
