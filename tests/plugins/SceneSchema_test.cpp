// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the schema of scene files, which the build makes, says of effects, against the classes' own tables of properties.
#include <geofx/SceneFile.h>
#include <tools/PropertySamples.h>

#include <osgDB/XmlParser>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

namespace
{

using geofx::test::expectSame;
using osgDB::XmlNode;
using osgGeoFX::createEffect;
using osgGeoFX::Effect;
using osgGeoFX::effectKinds;
using osgGeoFX::parseScene;
using osgGeoFX::Property;
using osgGeoFX::SceneResult;

using Kind = Property::Kind;

std::string attributeOf(const XmlNode& node, const std::string& name)
{
    const auto found = node.properties.find(name);
    return found == node.properties.end() ? "" : found->second;
}

/// One line, with single spaces.
std::string collapsed(const std::string& text)
{
    std::istringstream words(text);
    std::string result, word;
    while (words >> word)
        result += (result.empty() ? "" : " ") + word;
    return result;
}

class SceneSchema : public testing::Test
{
protected:
    void SetUp() override
    {
        std::ifstream stream(GEOFX_BUILD_DIR "/share/geofx.xsd");
        _document = osgDB::readXmlStream(stream);
        ASSERT_TRUE(_document);
        for (const osg::ref_ptr<XmlNode>& node : _document->children)
        {
            if (node->name == "xs:schema") _schema = node;
        }
        ASSERT_TRUE(_schema);
    }

    const XmlNode* named(const std::string& tag, const std::string& name) const
    {
        for (const osg::ref_ptr<XmlNode>& node : _schema->children)
            if (node->name == tag && attributeOf(*node, "name") == name) return node;
        return nullptr;
    }

    static const XmlNode* child(const XmlNode* node, const std::string& tag)
    {
        if (!node) return nullptr;
        for (const osg::ref_ptr<XmlNode>& each : node->children)
            if (each->name == tag) return each;
        return nullptr;
    }

    static std::string documentation(const XmlNode* node)
    {
        const XmlNode* words = child(child(node, "xs:annotation"), "xs:documentation");
        return words ? collapsed(words->contents) : "";
    }

    /// The elements of a type, by their names, with the names of their types.
    std::map<std::string, std::string> elementsOf(const std::string& type,
                                                  const std::string& compositor) const
    {
        std::map<std::string, std::string> result;
        if (const XmlNode* list = child(named("xs:complexType", type), compositor))
            for (const osg::ref_ptr<XmlNode>& node : list->children)
                result[attributeOf(*node, "name")] = attributeOf(*node, "type");
        return result;
    }

    /// The attributes of a type or of a group, with those of the groups that it refers to, in their order.
    std::vector<const XmlNode*> attributesOf(const XmlNode& parent) const
    {
        std::vector<const XmlNode*> result;
        for (const osg::ref_ptr<XmlNode>& node : parent.children)
        {
            if (node->name == "xs:attribute") result.push_back(node);
            if (node->name != "xs:attributeGroup") continue;
            const XmlNode* group = named("xs:attributeGroup", attributeOf(*node, "ref"));
            EXPECT_TRUE(group) << attributeOf(*node, "ref");
            EXPECT_NE(documentation(group), "");
            if (!group) continue;
            const std::vector<const XmlNode*> more = attributesOf(*group);
            result.insert(result.end(), more.begin(), more.end());
        }
        return result;
    }

    /// What restricts an attribute, its own or its type's.
    const XmlNode* restrictionOf(const XmlNode& attribute) const
    {
        const std::string type = attributeOf(attribute, "type");
        return child(type.empty() ? child(&attribute, "xs:simpleType") : named("xs:simpleType", type),
                     "xs:restriction");
    }

    static std::vector<std::string> facets(const XmlNode& restriction, const std::string& tag)
    {
        std::vector<std::string> result;
        for (const osg::ref_ptr<XmlNode>& node : restriction.children)
            if (node->name == tag) result.push_back(attributeOf(*node, "value"));
        return result;
    }

    void expectAttribute(const XmlNode& attribute, const Property& property) const
    {
        std::string error;
        double value = 0.0;
        // No data has no default, and may be a number with an exponent.
        const bool isNoData = property.name == "noData";
        if (isNoData)
            EXPECT_EQ(attribute.properties.count("default"), 0u);
        else
        {
            EXPECT_TRUE(property.parse(attributeOf(attribute, "default"), value, error)) << error;
            EXPECT_EQ(value, property.defaultValue) << "the default";
        }
        const XmlNode* restriction = restrictionOf(attribute);
        ASSERT_TRUE(restriction);
        const std::string words = documentation(&attribute);
        EXPECT_NE(words, "");
        if (property.kind == Kind::Choice || property.kind == Kind::Flag)
        {
            std::vector<std::string> choices;
            for (double each = property.minimum; each <= property.maximum; each += 1.0)
                choices.push_back(property.text(each));
            EXPECT_EQ(facets(*restriction, "xs:enumeration"), choices);
            for (const std::string& choice : choices)
                EXPECT_NE(words.find(choice), std::string::npos) << choice << " is not explained: " << words;
            return;
        }
        if (property.kind == Kind::Color)
        {
            EXPECT_EQ(facets(*restriction, "xs:pattern"), std::vector<std::string>{"#[0-9A-Fa-f]{6}"});
            return;
        }
        EXPECT_EQ(attributeOf(*restriction, "base"), property.kind == Kind::Integer ? "xs:int"
                                                     : isNoData                     ? "xs:double"
                                                                                    : "xs:decimal");
        const std::pair<const char*, double> limits[] = {{"xs:minInclusive", property.minimum},
                                                         {"xs:maxInclusive", property.maximum}};
        for (const auto& [tag, limit] : limits)
        {
            const std::vector<std::string> found = facets(*restriction, tag);
            ASSERT_EQ(found.size(), 1u) << tag;
            EXPECT_TRUE(property.parse(found[0], value, error)) << tag << ": " << error;
            EXPECT_EQ(value, limit) << tag;
            EXPECT_NE(words.find(found[0]), std::string::npos) << found[0] << " is not told: " << words;
        }
        const std::string unit = property.kind == Kind::Angle ? "degrees"
                                 : property.unit == "m"       ? "metres"
                                 : property.unit == "px"      ? "pixels"
                                                              : "";
        EXPECT_NE(words.find(unit), std::string::npos) << unit << " is not told: " << words;
    }

private:
    osg::ref_ptr<XmlNode> _document, _schema;
};

TEST_F(SceneSchema, HasEachKindOfEffectAndNoOther)
{
    const auto elements = elementsOf("Effects", "xs:choice");
    std::set<std::string> names;
    for (const auto& [name, type] : elements)
    {
        names.insert(name);
        EXPECT_NE(documentation(named("xs:complexType", type)), "") << type;
    }
    const std::vector<std::string> kinds = effectKinds();
    EXPECT_EQ(names, std::set<std::string>(kinds.begin(), kinds.end()));
}

TEST_F(SceneSchema, HasThePropertiesOfEachEffect)
{
    const auto elements = elementsOf("Effects", "xs:choice");
    for (const std::string& kind : effectKinds())
    {
        ASSERT_TRUE(elements.count(kind)) << kind;
        const XmlNode* type = named("xs:complexType", elements.at(kind));
        ASSERT_TRUE(type) << kind;
        const osg::ref_ptr<Effect> effect = createEffect(kind);
        std::vector<const XmlNode*> attributes = attributesOf(*type);
        // Pictures are no properties.
        const auto isFile = [](const XmlNode* attribute)
        {
            return attributeOf(*attribute, "type") == "File" && !documentation(attribute).empty();
        };
        attributes.erase(std::remove_if(attributes.begin(), attributes.end(), isFile), attributes.end());
        ASSERT_EQ(attributes.size(), effect->properties().size()) << kind;
        for (std::size_t i = 0; i < attributes.size(); ++i)
        {
            const Property& property = effect->properties()[i];
            SCOPED_TRACE(kind + "." + property.name);
            EXPECT_EQ(attributeOf(*attributes[i], "name"), property.name) << "the same order, too";
            expectAttribute(*attributes[i], property);
        }
        std::map<std::string, std::string> parts;
        for (const Effect::Part& part : effect->parts())
            parts[part.name] = elements.at(osgGeoFX::kindOf(*part.object));
        EXPECT_EQ(elementsOf(elements.at(kind), "xs:all"), parts) << kind;
    }
}

/// An element of <projectiveMappings> or <closeUps>: its type in the schema, the class behind it, and the properties that it
/// says in another way.
struct PartElement
{
    const char* type;
    const char* kind;
    std::set<std::string> missing;
    std::set<std::string> own = {}; ///< attributes that have the name of a property and a form of their own
};

const std::vector<PartElement>& partElements()
{
    static const std::vector<PartElement> all = {
        {"MappingLayer", "dataLayer", {"hasNoData"}},
        {"ColorTransfer", "colorTransfer", {}},
        {"CloseUp", "closeUp", {}},
        {"Region", "regionOfInterest", {}},
        {"Anchor", "anchor", {}},
        {"Mapping", "projectiveMapping", {}},
        {"MappingRoute",
         "routeMapping",
         {"order", "halfWidth", "color", "colorAlpha", "context"},
         {"order", "color", "context"}},
        {"MappingRaster",
         "projectiveMapping",
         {"centerX", "centerY",   "uX",     "uY",      "vX",    "vY",   "m00",         "m01",
          "m02",     "m10",       "m11",    "m12",     "m20",   "m21",  "m22",         "sizeInPixels",
          "turned",  "projector", "height", "heading", "pitch", "roll", "fieldOfView", "aspectRatio",
          "k1",      "k2",        "k3",     "p1",      "p2",    "range"}},
    };
    return all;
}

TEST_F(SceneSchema, HasThePropertiesOfWhatEffectsAreMadeOf)
{
    for (const PartElement& element : partElements())
    {
        const XmlNode* type = named("xs:complexType", element.type);
        ASSERT_TRUE(type) << element.type;
        EXPECT_NE(documentation(type), "") << element.type;
        const osg::ref_ptr<osgGeoFX::PropertyHolder> holder = osgGeoFX::createPropertyHolder(element.kind);
        std::vector<std::string> expected;
        std::set<std::string> missing = element.missing;
        for (const Property& property : holder->properties())
            if (missing.erase(property.name) == 0) expected.push_back(property.name);
        EXPECT_TRUE(missing.empty()) << element.type;
        std::vector<std::string> found;
        for (const XmlNode* attribute : attributesOf(*type))
        {
            const std::string name = attributeOf(*attribute, "name");
            if (element.own.count(name) > 0) continue;
            const auto& all = holder->properties();
            const auto property =
                std::find_if(all.begin(), all.end(), [&](const Property& each) { return each.name == name; });
            SCOPED_TRACE(std::string(element.type) + "." + name);
            if (property == all.end())
            {
                const bool saysWhatItIs =
                    attributeOf(*attribute, "type") == "File" || !documentation(attribute).empty();
                EXPECT_TRUE(saysWhatItIs);
                continue;
            }
            found.push_back(name);
            expectAttribute(*attribute, *property);
        }
        EXPECT_EQ(found, expected) << element.type;
        // Parts are elements in the element.
        std::set<std::string> parts;
        for (const osgGeoFX::PropertyHolder::Part& part : holder->parts())
            if (std::string(part.name) != "transfer") parts.insert(part.name);
        std::set<std::string> elements;
        for (const auto& [name, typeName] : elementsOf(element.type, "xs:all"))
            elements.insert(name);
        EXPECT_EQ(elements, parts) << element.type;
    }
}

/// The classes that elements are of. Surface data is not: an element says its place by its edges or its files. Nor is a clock: all
/// sequences of a scene share one.
std::vector<std::string> elementKinds()
{
    std::vector<std::string> kinds = osgGeoFX::propertyHolderKinds();
    for (const char* none : {"surfaceData", "layerClock"})
        kinds.erase(std::remove(kinds.begin(), kinds.end(), none), kinds.end());
    return kinds;
}

/// A scene with one element of a class, on line 2: an effect, or what mappings and close-ups are made of.
SceneResult sceneOf(const std::string& kind, const std::string& settings = {})
{
    std::string effects = "\n<" + kind + settings + "/>";
    if (kind == "projectiveMapping")
        effects = "<projectiveMappings>\n<mapping" + settings + "/></projectiveMappings>";
    if (kind == "dataLayer")
        effects = "<projectiveMappings>\n<layer name='a' file='a'" + settings + "/></projectiveMappings>";
    if (kind == "colorTransfer")
        effects = "<projectiveMappings>\n<transfer name='a'" + settings +
                  "/><mapping transfer='a'/></projectiveMappings>";
    if (kind == "routeMapping")
        effects = "<projectiveMappings>\n<route" + settings +
                  "><wayPoint longitude='0' latitude='0'/></route></projectiveMappings>";
    if (kind == "closeUp") effects = "<closeUps>\n<closeUp" + settings + "/></closeUps>";
    if (kind == "regionOfInterest")
        effects = "<closeUps><closeUp>\n<region" + settings + "/></closeUp></closeUps>";
    if (kind == "anchor") effects = "<closeUps><closeUp>\n<anchor" + settings + "/></closeUp></closeUps>";
    return parseScene("<geofx version='1'><terrain><database file='a'/></terrain><effects>" + effects +
                          "</effects></geofx>",
                      "x.geofx", "/");
}

std::string setting(const Property& property, const std::string& value)
{
    return " " + property.name + "='" + value + "'";
}

/// The object that such a scene has.
osgGeoFX::PropertyHolder& objectOf(const osgGeoFX::SceneFile& scene, const std::string& kind)
{
    if (createEffect(kind)) return *scene.effects.at(0);
    if (!scene.closeUps.empty())
    {
        osgGeoFX::CloseUp& closeUp = *scene.closeUps[0].closeUps.at(0).closeUp;
        if (kind == "regionOfInterest") return *closeUp.getRegion();
        if (kind == "anchor") return *closeUp.getAnchor();
        return closeUp;
    }
    const osgGeoFX::SceneMappings& mappings = scene.mappings.at(0);
    if (kind == "routeMapping")
    {
        static osg::ref_ptr<osgGeoFX::RouteMapping> route; // the caller looks at it at once
        route = new osgGeoFX::RouteMapping;
        std::string error;
        EXPECT_TRUE(route->setProperties(mappings.routes.at(0).look.properties, error)) << error;
        return *route;
    }
    if (kind == "dataLayer") return *mappings.layers.at(0).layer;
    if (kind == "colorTransfer") return *mappings.mappings.at(0).mapping->getTransfer();
    return *mappings.mappings.at(0).mapping;
}

TEST(SceneEffects, HaveTheDefaultsOfTheirClasses)
{
    for (const std::string& kind : elementKinds())
    {
        const SceneResult result = sceneOf(kind);
        ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
        ASSERT_EQ(result.scene->effects.size(), 1u);
        expectSame(objectOf(*result.scene, kind), *osgGeoFX::createPropertyHolder(kind));
    }
}

TEST(SceneEffects, TakeWhatTheTableTakesAndNameTheRest)
{
    for (const geofx::test::PropertyRow& row : geofx::test::allProperties())
    {
        if (row.name == "hasNoData" || row.kind == "surfaceData" || row.kind == "layerClock") continue;
        // Those of a form of its own: SceneMappings_test.cpp.
        const std::set<std::string> own = {"order", "halfWidth", "color", "colorAlpha", "context"};
        if (row.kind == "routeMapping" && own.count(row.name) > 0) continue;
        SCOPED_TRACE(row.kind + "." + row.name);
        const Property& property = row.property();
        std::string before;
        // Longitude and latitude belong together.
        if (row.kind == "regionOfInterest" && row.name == "longitude") before = " latitude='1'";
        if (row.kind == "regionOfInterest" && row.name == "latitude") before = " longitude='1'";
        const auto companion = geofx::test::companions().find(row.name);
        if (companion != geofx::test::companions().end())
        {
            const Property& other = *row.create()->property(companion->second.first);
            before = setting(other, std::to_string(static_cast<int>(companion->second.second)));
        }
        for (const double value : geofx::test::otherValues(row))
        {
            // XML's decimals have no exponent.
            const std::string text = property.text(value);
            if (text.find('e') != std::string::npos && property.choices.empty() &&
                property.kind != Kind::Flag)
                continue;
            const SceneResult result = sceneOf(row.kind, before + setting(property, text));
            ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
            EXPECT_DOUBLE_EQ(objectOf(*result.scene, row.kind).getProperty(row.name), value);
        }
        for (const char* text : {"", "x", "NaN", "INF", "-1e39", "1 2"})
        {
            const SceneResult result = sceneOf(row.kind, before + setting(property, text));
            EXPECT_FALSE(result.scene) << text;
            ASSERT_EQ(result.errors.size(), 1u) << text;
            const std::string& error = result.errors[0];
            EXPECT_EQ(error.rfind("x.geofx:2: <", 0), 0u) << error;
            EXPECT_NE(error.find(">: " + property.name), std::string::npos) << error;
            EXPECT_EQ(error.back(), '.') << error;
        }
        if (property.maximum >= 9e7) continue;
        for (const char* text : {"-99999999", "99999999"})
            EXPECT_EQ(sceneOf(row.kind, before + setting(property, text)).errors.size(), 1u) << text;
    }
}

TEST(SceneEffects, ALayersNoDataIsOne)
{
    for (const char* text : {"-3.4028234663852886e+38", "0", "+255", "-9999.5"})
    {
        const SceneResult result = sceneOf("dataLayer", std::string(" noData='") + text + "'");
        ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
        const osgGeoFX::DataLayer& layer = *result.scene->mappings.at(0).layers.at(0).layer;
        EXPECT_TRUE(layer.getHasNoData());
        EXPECT_EQ(layer.getNoData(), std::stod(text));
    }
}

} // namespace
