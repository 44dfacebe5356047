// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/Lengths.h>
#include <osgGeoFX/geodata/detail/Remarks.h>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

constexpr double metresPerSurveyFoot = 1200.0 / 3937.0;

struct Unit
{
    const char* word;
    double metres;
};

/// In small letters, without spaces, points, hyphens and underscores.
constexpr Unit units[] = {
    {"m", 1.0},
    {"metre", 1.0},
    {"meter", 1.0},
    {"metres", 1.0},
    {"meters", 1.0},
    {"mètres", 1.0},
    {"metros", 1.0},
    {"dm", 0.1},
    {"decimetre", 0.1},
    {"decimeter", 0.1},
    {"decimetres", 0.1},
    {"decimeters", 0.1},
    {"cm", 0.01},
    {"centimetre", 0.01},
    {"centimeter", 0.01},
    {"centimetres", 0.01},
    {"centimeters", 0.01},
    {"mm", 0.001},
    {"millimetre", 0.001},
    {"millimeter", 0.001},
    {"millimetres", 0.001},
    {"millimeters", 0.001},
    {"km", 1000.0},
    {"kilometre", 1000.0},
    {"kilometer", 1000.0},
    {"kilometres", 1000.0},
    {"kilometers", 1000.0},
    {"ft", 0.3048},
    {"foot", 0.3048},
    {"feet", 0.3048},
    {"internationalfoot", 0.3048},
    {"internationalfeet", 0.3048},
    {"ftus", metresPerSurveyFoot},
    {"usft", metresPerSurveyFoot},
    {"footus", metresPerSurveyFoot},
    {"surveyfoot", metresPerSurveyFoot},
    {"surveyfeet", metresPerSurveyFoot},
    {"ussurveyfoot", metresPerSurveyFoot},
    {"ussurveyfeet", metresPerSurveyFoot},
    {"ussurveyft", metresPerSurveyFoot},
    {"sft", metresPerSurveyFoot},
    {"yd", 0.9144},
    {"yard", 0.9144},
    {"yards", 0.9144},
    {"fathom", 1.8288},
    {"fathoms", 1.8288},
};

/// The number at a text's beginning, whatever the locale, and the place behind it.
std::optional<double> numberAt(const std::string& text, std::size_t& place)
{
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data() + place, text.data() + text.size(), value);
    if (failure != std::errc()) return {};
    place = static_cast<std::size_t>(end - text.data());
    return value;
}

bool isDigit(const std::string& text, std::size_t place)
{
    return place < text.size() && std::isdigit(static_cast<unsigned char>(text[place]));
}

/// The bytes of the mark between two groups of digits at a place; 0 if none stands there.
std::size_t groupMark(const std::string& text, std::size_t place)
{
    // The last three are spaces that do not break, and the apostrophe of printers.
    for (const char* const mark : {",", " ", "'", "\u00A0", "\u202F", "\u2019"})
    {
        const std::size_t length = std::char_traits<char>::length(mark);
        if (text.compare(place, length, mark) != 0) continue;
        const std::size_t digits = place + length;
        const bool three = isDigit(text, digits) && isDigit(text, digits + 1) && isDigit(text, digits + 2) &&
                           !isDigit(text, digits + 3);
        return three ? length : 0;
    }
    return 0;
}

/// A text without the marks between the groups of digits of its first number, and with a point for a decimal comma.
std::string plainNumber(const std::string& text)
{
    std::size_t place = std::min(text.find_first_not_of("+-"), text.size());
    std::string plain = text.substr(0, place);
    std::size_t digits = 0;
    for (; isDigit(text, place); ++place, ++digits)
        plain += text[place];
    if (digits > 0 && digits <= 3)
        while (const std::size_t mark = groupMark(text, place))
        {
            plain += text.substr(place + mark, 3);
            place += mark + 3;
        }
    std::string rest = text.substr(place);
    if (digits > 0 && !rest.empty() && rest[0] == ',' && isDigit(rest, 1)) rest[0] = '.';
    return plain + rest;
}

} // namespace

std::optional<double> Lengths::metresPerUnit(const std::string& unit)
{
    std::string word;
    for (const char c : unit)
        if (c != ' ' && c != '.' && c != '-' && c != '_')
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto* const found =
        std::find_if(std::begin(units), std::end(units), [&](const Unit& each) { return word == each.word; });
    if (found == std::end(units)) return {};
    return found->metres;
}

std::string Lengths::unitInWords(double metres)
{
    constexpr Unit names[] = {
        {"metres", 1.0},       {"feet", METRES_PER_FOOT}, {"US survey feet", metresPerSurveyFoot},
        {"decimetres", 0.1},   {"centimetres", 0.01},     {"millimetres", 0.001},
        {"kilometres", 1000.0}};
    // PROJ's feet differ in the last digits.
    for (const Unit& each : names)
        if (std::abs(metres - each.metres) < 1e-9 * metres) return each.word;
    return CPLSPrintf("units of %.9g m", metres);
}

std::optional<double> Lengths::read(const std::string& text, double metresPerPlain)
{
    const std::size_t start = text.find_first_not_of(" \t+");
    if (start == std::string::npos) return {};
    const std::string words = plainNumber(text.substr(start));
    std::size_t place = 0;
    const std::optional<double> value = numberAt(words, place);
    if (!value) return {};
    place = std::min(words.find_first_not_of(" \t", place), words.size());
    if (place == words.size()) return *value * metresPerPlain;
    if (words[place] == '\'' || words.compare(place, 3, "\u2032") == 0)
    {
        // 12'6": feet and inches.
        place += words[place] == '\'' ? 1 : 3;
        const double inches = place < words.size() ? numberAt(words, place).value_or(0.0) : 0.0;
        return (*value + inches / 12.0) * METRES_PER_FOOT;
    }
    const std::string rest = words.substr(place);
    std::optional<double> metres = metresPerUnit(rest);
    if (!metres) metres = metresPerUnit(rest.substr(0, rest.find_first_of(" ;,(/")));
    if (!metres) return {};
    return *value * *metres;
}

double Lengths::metresPerHeight(GDALRasterBand& band, const OGRSpatialReference& srs, const std::string& file)
{
    const char* const given = band.GetUnitType();
    const std::string unit = given ? given : "";
    if (unit.empty()) return srs.IsCompound() ? srs.GetTargetLinearUnits("COMPD_CS|VERT_CS") : 1.0;
    if (const auto metres = metresPerUnit(unit)) return *metres;
    remarkOnce(file + ": the unit of its heights, \"" + unit.substr(0, 40) +
               "\", is not known. They are taken as metres; if they are not, set the unit with gdal_edit.py "
               "-units.");
    return 1.0;
}

} // namespace osgGeoFX
