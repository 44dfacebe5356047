// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/Vec2d>
#include <osg/Vec4>

#include <memory>
#include <string>
#include <vector>

struct _cairo; // cairo_t of Cairo

namespace osgGeoFX
{

/// The look of names. Lengths are pixels of the picture. A plain value.
/// @ingroup labels
struct LabelStyle
{
    std::string font =
        "sans-serif"; ///< families, separated by commas; the first one that has a letter draws it
    bool bold = false;
    bool italic = false;
    double size = 16.0;   ///< the font's size (its em), pixels; 1…2,000
    double spacing = 0.0; ///< between letters, of the size; 0…4. Scripts whose letters join ignore it.
    osg::Vec4 color = {0.10f, 0.10f, 0.12f, 1.0f}; ///< red, green, blue, alpha; 0…1
    osg::Vec4 halo = {1.0f, 1.0f, 1.0f, 0.85f};
    double haloWidth = 0.14; ///< around the letters, of the size; 0: none
    double longest = 30.0;   ///< of the size: a longer name ends with an ellipsis
};

/** A name as Pango lays it out: letters of any script joined, ordered and stacked as they must be, with fonts that have
    them. Immutable.

    Each thread may have texts of its own; one text may be used by one thread at a time.
    @ingroup labels */
class OSGGEOFXMAPS_EXPORT LabelText
{
public:
    /// Bytes that are not UTF-8 become replacement characters; line breaks and control characters become blanks.
    LabelText(const std::string& text, const LabelStyle& style);
    ~LabelText();
    LabelText(LabelText&&) noexcept;
    LabelText& operator=(LabelText&&) noexcept;

    /// The box of the ink with its halo, pixels: its size, and how far it reaches above the baseline and to the left of the
    /// text's origin. All are 0 if there is nothing to be seen.
    double width() const;
    double height() const;
    double above() const;
    double left() const;
    /// Whether the text would have been longer than the style allows.
    bool isCut() const;
    /// How many letters no font has. They are drawn as boxes.
    int missingLetters() const;

    /// Draws the text with its halo. (x, y): the origin, at the baseline's left end; y points down, as Cairo has it.
    void draw(_cairo* target, double x, double y) const;
    /// The same along a curve in pixels, y down, centered on it. Each point of each letter lies as far along the curve and
    /// beside it as it does on the line. False, and nothing is drawn, if the curve is shorter than the text.
    bool drawAlong(_cairo* target, const std::vector<osg::Vec2d>& curve) const;
    /// The box as an image of premultiplied RGBA with the first row lowest, `margin` clear pixels around it. Its origin lies
    /// on a whole pixel. Null if there is nothing to be seen.
    osg::ref_ptr<osg::Image> image(int margin = 1) const;

private:
    struct Layout;
    std::unique_ptr<Layout> _layout;
};

/// Makes the font of a file known in this process. `family`: its family's name, for LabelStyle::font. False, with a sentence in
/// `error`, if the file has no font. Call it before the first text is laid out.
/// @ingroup labels
OSGGEOFXMAPS_EXPORT bool addFontFile(const std::string& file, std::string& family, std::string& error);

} // namespace osgGeoFX
