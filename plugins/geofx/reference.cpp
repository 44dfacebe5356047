// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A program for the build: writes what follows from the classes' tables of properties.
//   geofx_reference schema TEMPLATE OUTPUT    the schema of scene files
//   geofx_reference page OUTPUT               the page of all properties, Markdown
//   geofx_reference setters OUTPUT            a list of classes and properties, C++, for the test of typed setters
#include <osgGeoFX/viewer/EffectKinds.h>

#include <libxml/parser.h>
#include <libxml/tree.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace
{

using osgGeoFX::Property;
using osgGeoFX::PropertyHolder;
using Kind = Property::Kind;

/// A name with its first letter made large.
std::string capitalized(std::string name)
{
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
}

osg::ref_ptr<PropertyHolder> holderOf(const std::string& kind)
{
    osg::ref_ptr<PropertyHolder> holder = osgGeoFX::createPropertyHolder(kind);
    if (!holder) throw std::runtime_error("There is no kind \"" + kind + "\".");
    return holder;
}

/// The schema's template with what it asks for.
class Schema
{
public:
    explicit Schema(const std::string& file)
        : _document(xmlReadFile(file.c_str(), nullptr, XML_PARSE_NONET | XML_PARSE_NOBLANKS))
    {
        if (!_document) throw std::runtime_error(file + " cannot be read as XML.");
    }
    ~Schema() { xmlFreeDoc(_document); }
    Schema(const Schema&) = delete;
    Schema& operator=(const Schema&) = delete;

    void fill()
    {
        xmlNode* root = xmlDocGetRootElement(_document);
        _xs = xmlSearchNs(_document, root, chars("xs"));
        visit(root);
        // Nothing is left of the template's own names.
        for (xmlNs** next = &root->nsDef; *next;)
        {
            xmlNs* each = *next;
            if (std::strcmp(reinterpret_cast<const char*>(each->prefix), "geofx") != 0)
            {
                next = &each->next;
                continue;
            }
            *next = each->next;
            xmlFreeNs(each);
        }
    }

    void write(const std::string& file) const
    {
        if (xmlSaveFormatFileEnc(file.c_str(), _document, "UTF-8", 1) < 0)
            throw std::runtime_error(file + " cannot be written.");
    }

private:
    static const xmlChar* chars(const char* text) { return reinterpret_cast<const xmlChar*>(text); }
    static const xmlChar* chars(const std::string& text) { return chars(text.c_str()); }

    static std::string attribute(xmlNode* node, const char* name)
    {
        xmlChar* value = xmlGetNoNsProp(node, chars(name));
        std::string text = value ? reinterpret_cast<const char*>(value) : "";
        xmlFree(value);
        return text;
    }

    static std::vector<std::string> words(const std::string& text)
    {
        std::istringstream stream(text);
        return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
    }

    void visit(xmlNode* parent)
    {
        for (xmlNode* node = parent->children; node;)
        {
            xmlNode* next = node->next;
            const bool asks = node->type == XML_ELEMENT_NODE && node->ns && node->ns != _xs;
            if (!asks)
                visit(node);
            else
            {
                const std::string kind = attribute(node, "of");
                if (std::strcmp(reinterpret_cast<const char*>(node->name), "description") == 0)
                    xmlAddPrevSibling(node, xmlNewText(chars(osgGeoFX::describeKind(kind))));
                else
                    addProperties(node, *holderOf(kind));
                xmlUnlinkNode(node);
                xmlFreeNode(node);
            }
            node = next;
        }
    }

    void addProperties(xmlNode* place, const PropertyHolder& holder)
    {
        const std::vector<std::string> without = words(attribute(place, "without"));
        const std::vector<std::string> optional = words(attribute(place, "optional"));
        const auto isIn = [](const std::vector<std::string>& list, const std::string& name)
        {
            return std::find(list.begin(), list.end(), name) != list.end();
        };
        for (const std::string& name : without)
            if (!holder.property(name))
                throw std::runtime_error(std::string(holder.className()) + " has no property " + name + ".");
        for (const Property& property : holder.properties())
            if (!isIn(without, property.name))
                xmlAddPrevSibling(place, attributeOf(property, isIn(optional, property.name)));
    }

    xmlNode* element(const char* name) const { return xmlNewNode(_xs, chars(name)); }

    xmlNode* attributeOf(const Property& property, bool isOptional) const
    {
        xmlNode* result = element("attribute");
        xmlNewProp(result, chars("name"), chars(property.name));
        if (!isOptional) xmlNewProp(result, chars("default"), chars(property.text(property.defaultValue)));
        xmlNode* documentation = element("documentation");
        xmlAddChild(documentation,
                    xmlNewText(chars(property.documentation() + (isOptional ? "; none by default" : ""))));
        xmlAddChild(xmlAddChild(result, element("annotation")), documentation);
        xmlAddChild(xmlAddChild(result, element("simpleType")), restrictionOf(property));
        return result;
    }

    void addFacet(xmlNode* restriction, const char* name, const std::string& value) const
    {
        xmlNewProp(xmlAddChild(restriction, element(name)), chars("value"), chars(value));
    }

    xmlNode* restrictionOf(const Property& property) const
    {
        xmlNode* result = element("restriction");
        const bool isNumber = property.kind == Kind::Number || property.kind == Kind::Angle;
        // XML's decimals have no exponent.
        const bool isDecimal = isNumber && std::abs(property.maximum) < 1e15;
        xmlNewProp(result, chars("base"),
                   chars(isDecimal                        ? "xs:decimal"
                         : isNumber                       ? "xs:double"
                         : property.kind == Kind::Integer ? "xs:int"
                                                          : "xs:token"));
        if (property.kind == Kind::Flag)
            for (const double value : {0.0, 1.0})
                addFacet(result, "enumeration", property.text(value));
        for (const Property::Choice& choice : property.choices)
            addFacet(result, "enumeration", choice.name);
        if (property.kind == Kind::Color) addFacet(result, "pattern", "#[0-9A-Fa-f]{6}");
        if (isNumber || property.kind == Kind::Integer)
        {
            addFacet(result, "minInclusive", property.text(property.minimum));
            addFacet(result, "maxInclusive", property.text(property.maximum));
        }
        return result;
    }

    xmlDoc* _document;
    xmlNs* _xs = nullptr;
};

std::string page()
{
    std::string text =
        "<!-- Made by the build from the classes' tables; see tests/README.md. -->\n"
        "# Effects and their properties\n\n"
        "Scene files, `--effect` and `setProperty()` use these names. In files and on command lines "
        "lengths are in metres and angles in degrees; in C++ angles are in radians.\n";
    for (const std::string& kind : osgGeoFX::propertyHolderKinds())
    {
        const osg::ref_ptr<PropertyHolder> holder = holderOf(kind);
        text += "\n## " + kind + "\n\n" + osgGeoFX::describeKind(kind) + "\n\n";
        text += "| property | default | what it is |\n| --- | --- | --- |\n";
        for (const Property& property : holder->properties())
            text += "| `" + property.name + "` | " + property.text(property.defaultValue) + " | " +
                    property.documentation() + " |\n";
    }
    return text;
}

std::string setters()
{
    std::string text;
    for (const std::string& kind : osgGeoFX::propertyHolderKinds())
        for (const Property& property : holderOf(kind)->properties())
            text += "GEOFX_PROPERTY(" + kind + ", " + capitalized(kind) + ", " + property.name + ", " +
                    capitalized(property.name) + ")\n";
    return text;
}

void write(const std::string& file, const std::string& text)
{
    std::ofstream stream(file);
    stream << text;
    if (!stream.flush()) throw std::runtime_error(file + " cannot be written.");
}

} // namespace

int main(int count, char** arguments)
try
{
    const std::vector<std::string> words(arguments + 1, arguments + count);
    if (words.size() == 3 && words[0] == "schema")
    {
        Schema schema(words[1]);
        schema.fill();
        schema.write(words[2]);
    }
    else if (words.size() == 2 && words[0] == "page")
        write(words[1], page());
    else if (words.size() == 2 && words[0] == "setters")
        write(words[1], setters());
    else
        throw std::runtime_error(
            "Usage: geofx_reference schema TEMPLATE OUTPUT | page OUTPUT | setters OUTPUT");
    return 0;
}
catch (const std::exception& error)
{
    std::cerr << error.what() << std::endl;
    return 2;
}
