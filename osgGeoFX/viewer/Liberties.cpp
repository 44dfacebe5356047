// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/Liberties.h>

#include <osg/Math>

#include <sstream>

namespace osgGeoFX
{

osg::ref_ptr<RegionalLiberty> makeLiberty(const PanoramaLiberty& from, bool geocentric)
{
    osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    if (geocentric)
        liberty->setGeodeticCenter(std::remainder(osg::DegreesToRadians(from.place.x()), 2.0 * osg::PI),
                                   osg::DegreesToRadians(from.place.y()));
    else
        liberty->setCenter(from.place);
    liberty->setRadii(from.across, from.along);
    liberty->setHeading(from.heading);
    liberty->setEnlarge(from.enlarge);
    liberty->setBaseHeight(from.baseHeight);
    liberty->setWiden(from.widen);
    liberty->setLengthen(from.lengthen);
    liberty->setTurn(from.turn);
    return liberty;
}

PanoramaLiberty libertyOf(const RegionalLiberty& from, bool geocentric)
{
    PanoramaLiberty liberty;
    liberty.place = geocentric ? osg::Vec2d(osg::RadiansToDegrees(from.getLongitude()),
                                            osg::RadiansToDegrees(from.getLatitude()))
                               : from.getCenter();
    liberty.across = from.getAcross();
    liberty.along = from.getAlong();
    liberty.heading = from.getHeading();
    liberty.baseHeight = from.getBaseHeight();
    const double strength = from.isActive() ? from.getStrength() : 0.0;
    liberty.enlarge = 1.0 + strength * (from.getEnlarge() - 1.0);
    liberty.widen = 1.0 + strength * (from.getWiden() - 1.0);
    liberty.lengthen = 1.0 + strength * (from.getLengthen() - 1.0);
    liberty.turn = strength * from.getTurn();
    return liberty;
}

osg::ref_ptr<RegionalLiberty> parseLiberty(const std::string& text, bool geocentric, std::string& error)
{
    std::istringstream words(text);
    std::string word;
    words >> word;
    const std::size_t comma = word.find(',');
    if (comma == std::string::npos)
    {
        error = "\"" + text + "\" names no center; write two numbers first, such as 7.66,45.98 enlarge=1.3.";
        return nullptr;
    }
    PropertyHolder::Texts texts = {{geocentric ? "longitude" : "centerX", word.substr(0, comma)},
                                   {geocentric ? "latitude" : "centerY", word.substr(comma + 1)}};
    while (words >> word)
    {
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos)
        {
            error = "\"" + word + "\" sets nothing; write property=value, such as enlarge=1.3.";
            return nullptr;
        }
        const std::string name = word.substr(0, equals), value = word.substr(equals + 1);
        for (const char* const each : {"across", "along"})
            if (name == "radius") texts.emplace_back(each, value);
        if (name != "radius") texts.emplace_back(name, value);
    }
    osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    return liberty->setPropertyTexts(texts, error) ? liberty : nullptr;
}

void addLiberty(EffectScene& scene, RegionalLiberty& liberty)
{
    unsigned int index = 0;
    while (index < scene.getNumEffects() && (!dynamic_cast<const Deformation*>(scene.getEffect(index)) ||
                                             dynamic_cast<const RegionalLiberty*>(scene.getEffect(index))))
        ++index;
    scene.insertEffect(index, &liberty);
}

} // namespace osgGeoFX
