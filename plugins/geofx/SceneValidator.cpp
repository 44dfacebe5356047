// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneValidator.h"

#include "SceneFile.h"
#include "SceneSchema.h"

#include <libxml/SAX2.h>
#include <libxml/parser.h>
#include <libxml/xmlschemas.h>
#include <libxml/xmlschemastypes.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <mutex>

namespace osgGeoFX
{

namespace
{

const char* chars(const xmlChar* text)
{
    return reinterpret_cast<const char*>(text);
}
const xmlChar* xmlChars(const char* text)
{
    return reinterpret_cast<const xmlChar*>(text);
}

bool is(const xmlNode* node, const char* name)
{
    return node->type == XML_ELEMENT_NODE && std::strcmp(chars(node->name), name) == 0;
}

/// One line, with single spaces.
std::string collapsed(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        const bool space = c == ' ' || c == '\n' || c == '\r' || c == '\t';
        if (!space)
            result += c;
        else if (!result.empty() && result.back() != ' ')
            result += ' ';
    }
    if (!result.empty() && result.back() == ' ') result.pop_back();
    return result;
}

std::string textOf(const xmlNode* node)
{
    xmlChar* content = xmlNodeGetContent(node);
    std::string text = collapsed(content ? chars(content) : "");
    xmlFree(content);
    return text;
}

xmlDoc* readMemory(xmlParserCtxt* context, const char* text, std::size_t size)
{
    // No file and no network; what libxml2 has to say goes to the handler alone.
    return xmlCtxtReadMemory(context, text, static_cast<int>(size), nullptr, nullptr,
                             XML_PARSE_NONET | XML_PARSE_BIG_LINES);
}

/// The schema, as XML to look up what it says in words, and compiled.
class Schema
{
public:
    Schema()
        : _document(xmlReadMemory(sceneSchema, static_cast<int>(std::strlen(sceneSchema)), nullptr, nullptr,
                                  XML_PARSE_NONET | XML_PARSE_NOBLANKS))
    {
        xmlSchemaParserCtxt* parser = xmlSchemaNewDocParserCtxt(_document.get());
        _schema = xmlSchemaParse(parser);
        xmlSchemaFreeParserCtxt(parser);
    }
    ~Schema() { xmlSchemaFree(_schema); }
    Schema(const Schema&) = delete;
    Schema& operator=(const Schema&) = delete;

    /// The one that all threads share. Compiling it takes many times as long as validating a scene.
    static const Schema& shared()
    {
        static const Schema schema;
        return schema;
    }

    /// Validators of several threads may use it at once: they keep what they find in contexts of their own.
    xmlSchema* compiled() const { return _schema; }

    /// Names of the elements (kind "element") or attributes ("attribute") that an element may have.
    std::vector<std::string> namesIn(const std::string& element, const char* kind,
                                     bool requiredOnly = false) const
    {
        std::vector<std::string> names;
        if (const xmlNode* type = typeOf(element)) collect(type, kind, requiredOnly, names);
        return names;
    }

    /// Whether the elements in an element have an order, or exclude each other.
    bool isOrdered(const std::string& element) const { return has(element, "sequence"); }
    bool isChoice(const std::string& element) const { return has(element, "choice"); }

    /// What an attribute's value should be, in words.
    std::string expectation(const std::string& element, const std::string& attribute) const
    {
        const xmlNode* type = typeOf(element);
        const xmlNode* declaration = type ? find(type, "attribute", attribute) : nullptr;
        if (!declaration) return {};
        const std::string words = documentation(declaration);
        const std::string typeName = attributeOf(const_cast<xmlNode*>(declaration), "type");
        return words.empty() ? documentation(find(root(), "simpleType", typeName)) : words;
    }

private:
    const xmlNode* root() const { return xmlDocGetRootElement(_document.get()); }

    /// The group of attributes that a node refers to; the node itself where it is no reference.
    const xmlNode* referred(const xmlNode* node) const
    {
        const std::string name =
            is(node, "attributeGroup") ? attributeOf(const_cast<xmlNode*>(node), "ref") : std::string();
        return name.empty() ? node : find(root(), "attributeGroup", name);
    }

    /// The first descendant of a kind with a name. Element names mean the same wherever they stand.
    const xmlNode* find(const xmlNode* parent, const char* kind, const std::string& name) const
    {
        for (const xmlNode* child = parent->children; child; child = child->next)
        {
            if (child->type != XML_ELEMENT_NODE) continue;
            const xmlNode* node = std::strcmp(kind, "attribute") == 0 ? referred(child) : child;
            if (is(node, kind) && attributeOf(const_cast<xmlNode*>(node), "name") == name) return node;
            if (const xmlNode* below = find(node, kind, name)) return below;
        }
        return nullptr;
    }

    const xmlNode* typeOf(const std::string& element) const
    {
        const xmlNode* declaration = find(root(), "element", element);
        if (!declaration) return nullptr;
        const std::string type = attributeOf(const_cast<xmlNode*>(declaration), "type");
        return type.empty() ? declaration : find(root(), "complexType", type);
    }

    bool has(const std::string& element, const char* compositor) const
    {
        const xmlNode* node = typeOf(element);
        for (node = node ? node->children : nullptr; node && !is(node, compositor);)
            node = node->next;
        return node != nullptr;
    }

    void collect(const xmlNode* parent, const char* kind, bool requiredOnly,
                 std::vector<std::string>& names) const
    {
        for (xmlNode* node = parent->children; node; node = node->next)
        {
            if (node->type != XML_ELEMENT_NODE) continue;
            // Attributes of elements within are theirs.
            if (is(node, "element") && std::strcmp(kind, "element") != 0) continue;
            if (!is(node, kind))
                collect(referred(node), kind, requiredOnly, names);
            else if (!requiredOnly || attributeOf(node, "use") == "required")
                names.push_back(attributeOf(node, "name"));
        }
    }

    static std::string documentation(const xmlNode* declaration)
    {
        for (const xmlNode* node = declaration ? declaration->children : nullptr; node; node = node->next)
            if (is(node, "annotation")) return textOf(node);
        return {};
    }

    XmlDocument _document;
    xmlSchema* _schema = nullptr;
};

std::string listed(const std::vector<std::string>& names, const std::string& before, const std::string& after)
{
    std::string text;
    for (const std::string& name : names)
    {
        if (!text.empty()) text += ", ";
        text.append(before).append(name).append(after);
    }
    return text;
}

/// Collects what the parser and the validator find, as sentences.
class Findings
{
public:
    Findings(const std::string& file, std::vector<std::string>& errors) : _file(file), _errors(errors) {}

    void add(const xmlNode* element, const std::string& text)
    {
        add(static_cast<int>(std::min<long>(xmlGetLineNo(element), std::numeric_limits<int>::max())),
            chars(element->name), text);
    }

    void add(int line, const std::string& element, const std::string& text)
    {
        const std::string sentence = ScenePlace{_file, line, element}.message(text);
        const bool known = std::find(_errors.begin(), _errors.end(), sentence) != _errors.end();
        if (!known && _errors.size() < mostErrors) _errors.push_back(sentence);
    }

    /// libxml2's parser calls this.
    static void malformed(void* data, xmlErrorPtr error)
    {
        auto* parser = static_cast<xmlParserCtxt*>(data);
        auto* findings = static_cast<Findings*>(parser->_private);
        if (error->level < XML_ERR_ERROR || !findings->_errors.empty())
            return; // the rest follows from the first
        findings->add(error->line, parser->node ? chars(parser->node->name) : "geofx",
                      "this is not well-formed XML: " + collapsed(error->message ? error->message : "") +
                          ".");
    }

    /// libxml2's parser calls this before it reads what a document type declares: entities that grow, and defaults.
    static void typed(void* data, const xmlChar*, const xmlChar*, const xmlChar*)
    {
        auto* parser = static_cast<xmlParserCtxt*>(data);
        static_cast<Findings*>(parser->_private)
            ->add(xmlSAX2GetLineNumber(parser), "geofx",
                  "a document type is declared; expected: no <!DOCTYPE>.");
        xmlStopParser(parser);
    }

    /// libxml2's validator calls this.
    static void invalid(void* data, xmlErrorPtr error) { static_cast<Findings*>(data)->translate(*error); }

    const Schema& schema = Schema::shared();

private:
    void translate(const xmlError& error)
    {
        auto* node = static_cast<xmlNode*>(error.node);
        if (node && node->type == XML_ATTRIBUTE_NODE) node = node->parent;
        if (!node) return;
        const std::string message = collapsed(error.message ? error.message : "");
        const std::string attribute = attributeIn(message), name = chars(node->name);
        const std::string expectation = attribute.empty() ? "" : schema.expectation(name, attribute);
        if (error.code == XML_SCHEMAV_CVC_COMPLEX_TYPE_3_2_1 || (!attribute.empty() && expectation.empty()))
        {
            const std::string known = listed(schema.namesIn(name, "attribute"), "", "");
            add(node, "the attribute \"" + attribute + "\" is not known here; expected: " +
                          (known.empty() ? "no attributes" : known) + ".");
        }
        else if (!attribute.empty())
            add(node, attribute + "=\"" + attributeOf(node, attribute.c_str()) +
                          "\" is not allowed; expected: " + expectation + ".");
        else if (error.code == XML_SCHEMAV_CVC_COMPLEX_TYPE_4)
            add(node, missingAttributes(node));
        else if (error.code == XML_SCHEMAV_ELEMENT_CONTENT)
            add(node, wrongContent(*node, message));
        else if (error.code == XML_SCHEMAV_CVC_COMPLEX_TYPE_2_1)
            add(node, "something stands inside this element; expected: nothing, <" + name + "/>.");
        else if (error.code == XML_SCHEMAV_CVC_COMPLEX_TYPE_2_3)
            add(node, "text stands inside this element; expected: elements only.");
        else if (error.code == XML_SCHEMAV_CVC_ELT_1)
            add(node,
                "this is no scene; expected: <geofx version=\"1\">, without a namespace, as the outermost "
                "element.");
        else
            add(node, message);
    }

    /// The attribute that a message of libxml2 is about ("Element 'sun', attribute 'azimuth': …"); empty if
    /// none.
    static std::string attributeIn(const std::string& message)
    {
        const std::string before = "', attribute '";
        const std::size_t found = message.find(before);
        if (found == std::string::npos || found > message.find("':")) return {};
        const std::size_t begin = found + before.size();
        return message.substr(begin, message.find('\'', begin) - begin);
    }

    std::string missingAttributes(xmlNode* element) const
    {
        std::vector<std::string> missing;
        for (const std::string& name : schema.namesIn(chars(element->name), "attribute", true))
            if (!xmlHasProp(element, xmlChars(name.c_str())))
                missing.push_back(name + " (" + schema.expectation(chars(element->name), name) + ")");
        return "an attribute is missing; expected: " + listed(missing, "", "") + ".";
    }

    std::string wrongContent(const xmlNode& node, const std::string& message) const
    {
        const bool isMissing = message.find("Missing child") != std::string::npos;
        const std::string parent = chars(isMissing ? node.name : node.parent->name);
        const std::vector<std::string> known = schema.namesIn(parent, "element");
        const std::string all = listed(known, "<", ">");
        if (isMissing)
            return parent == "geofx"
                       ? "the element <terrain> is missing; expected: <terrain> and what it is made of."
                       : "an element is missing; expected: " + expectedBy(message, all) + ".";
        if (std::find(known.begin(), known.end(), chars(node.name)) == known.end())
            return "this element is not known in <" + parent + ">; expected: " + expectedBy(message, all) +
                   ".";
        if (schema.isOrdered(parent))
            return "this element is out of place; expected: " + expectedBy(message, all + ", in this order") +
                   ".";
        return "this element is one too many; expected: " +
               std::string(schema.isChoice(parent) ? "only one of " : "at most one each of ") + all + ".";
    }

    /// The elements that the validator names as possible at this point.
    static std::string expectedBy(const std::string& message, const std::string& otherwise)
    {
        const std::size_t begin = message.rfind("( "), end = message.rfind(" )");
        if (begin == std::string::npos || end == std::string::npos || end < begin + 2) return otherwise;
        std::string names = "<" + message.substr(begin + 2, end - begin - 2) + ">";
        for (std::size_t comma = names.find(", "); comma != std::string::npos;
             comma = names.find(", ", comma + 4))
            names.replace(comma, 2, "> or <");
        return names;
    }

    std::string _file;
    std::vector<std::string>& _errors;
};

/// What isGiven() asks for.
void markGiven(xmlNode* parent)
{
    for (xmlNode* node = parent; node; node = node->next)
    {
        if (node->type != XML_ELEMENT_NODE) continue;
        for (xmlAttr* attribute = node->properties; attribute; attribute = attribute->next)
            attribute->_private = attribute;
        markGiven(node->children);
    }
}

/// The first element <geofx> below a node; null for none.
xmlNode* firstScene(xmlNode* parent)
{
    for (xmlNode* node = parent->children; node; node = node->next)
    {
        if (node->type != XML_ELEMENT_NODE) continue;
        if (is(node, "geofx")) return node;
        if (xmlNode* below = firstScene(node)) return below;
    }
    return nullptr;
}

/// The name among `names` that differs from `name` in case at most; empty for none.
std::string spelled(const std::vector<std::string>& names, const std::string& name)
{
    const auto found =
        std::find_if(names.begin(), names.end(),
                     [&](const std::string& each)
                     { return xmlStrcasecmp(xmlChars(each.c_str()), xmlChars(name.c_str())) == 0; });
    return found == names.end() ? std::string() : *found;
}

/// The node and all below. A child is an attribute if the schema has one of its name, or has no such element either.
xmlNode* makeElement(const SceneElement& from, const std::string& name, Findings& findings)
{
    xmlNode* node = xmlNewNode(nullptr, xmlChars(name.c_str()));
    const std::vector<std::string> attributes = findings.schema.namesIn(name, "attribute");
    const std::vector<std::string> elements = findings.schema.namesIn(name, "element");
    const auto isText = [&](const std::string& text)
    {
        if (xmlCheckUTF8(xmlChars(text.c_str()))) return true;
        findings.add(node, "a text in this element is not UTF-8; expected: a file in UTF-8.");
        return false;
    };
    for (const SceneElement& child : from.children)
    {
        // XML's own attributes, such as the place of a schema, are none of the scene's. A file that cannot be included has no name.
        if (child.name.empty() || child.name.find(':') != std::string::npos) continue;
        if (!isText(child.name) || !isText(child.value)) continue;
        const std::string attribute = spelled(attributes, child.name);
        const std::string element = spelled(elements, child.name);
        const bool isKnown = !attribute.empty() || !element.empty();
        const bool isAttribute =
            child.children.empty() && (isKnown ? !attribute.empty() : !child.value.empty());
        if (!isAttribute)
            xmlAddChild(node, makeElement(child, element.empty() ? child.name : element, findings));
        else
            xmlNewProp(node, xmlChars((attribute.empty() ? child.name : attribute).c_str()),
                       xmlChars(child.value.c_str()));
    }
    if (!from.value.empty() && isText(from.value)) xmlNodeAddContent(node, xmlChars(from.value.c_str()));
    return node;
}

/// What can be read of a text, however malformed it is; null for nothing. No document type is read.
XmlDocument readLeniently(const std::string& text)
{
    if (text.empty() || text.size() > largestScene) return nullptr;
    xmlParserCtxt* parser = xmlNewParserCtxt();
    parser->sax->internalSubset = nullptr;
    XmlDocument document(xmlCtxtReadMemory(
        parser, text.data(), static_cast<int>(text.size()), nullptr, nullptr,
        XML_PARSE_NONET | XML_PARSE_BIG_LINES | XML_PARSE_RECOVER | XML_PARSE_NOERROR | XML_PARSE_NOWARNING));
    xmlFreeParserCtxt(parser);
    return document;
}

/// Gives elements the lines of those in a text, down to the first that is another one there.
void takeLines(xmlNode* node, const xmlNode* from)
{
    node->line = from->line;
    xmlNode* child = xmlFirstElementChild(node);
    for (const xmlNode* other = xmlFirstElementChild(const_cast<xmlNode*>(from)); child && other;
         child = xmlNextElementSibling(child), other = xmlNextElementSibling(const_cast<xmlNode*>(other)))
    {
        if (xmlStrcasecmp(child->name, other->name) != 0) return;
        takeLines(child, other);
    }
}

/// The types of the schema are made at their first use, which two threads must not do at once.
void initialize()
{
    static std::once_flag once;
    std::call_once(once,
                   []
                   {
                       xmlInitParser();
                       xmlSchemaInitTypes();
                   });
}

void validate(xmlDoc* document, Findings& findings)
{
    xmlNode* root = xmlDocGetRootElement(document);
    const std::string version = attributeOf(root, "version");
    if (is(root, "geofx") && !root->ns && !version.empty() && version != "1")
    {
        findings.add(root, "version=\"" + version + "\" is not known to this osgGeoFX; expected: " +
                               findings.schema.expectation("geofx", "version") +
                               ". A newer osgGeoFX may read this scene.");
        return;
    }
    markGiven(root);
    xmlSchemaValidCtxt* validator = xmlSchemaNewValidCtxt(findings.schema.compiled());
    xmlSchemaSetValidStructuredErrors(validator, &Findings::invalid, &findings);
    xmlSchemaSetValidOptions(validator, XML_SCHEMA_VAL_VC_I_CREATE); // fills in the defaults
    xmlSchemaValidateDoc(validator, document);
    xmlSchemaFreeValidCtxt(validator);
}

} // namespace

std::string attributeOf(xmlNode* element, const char* name)
{
    xmlChar* value = xmlGetNoNsProp(element, xmlChars(name));
    const std::string text = value ? chars(value) : "";
    xmlFree(value);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
}

bool isGiven(xmlNode* element, const char* name)
{
    const xmlAttr* attribute = xmlHasNsProp(element, xmlChars(name), nullptr);
    return attribute && attribute->_private;
}

XmlDocument readSceneXml(const std::string& text, const std::string& file, std::vector<std::string>& errors)
{
    initialize();
    Findings findings(file, errors);
    if (text.empty() || text.size() > largestScene)
    {
        findings.add(1, "geofx",
                     std::string("the file is ") +
                         (text.empty() ? "empty or cannot be read" : "larger than 16 MiB") +
                         "; expected: a scene in XML.");
        return nullptr;
    }

    xmlParserCtxt* parser = xmlNewParserCtxt();
    parser->_private = &findings;
    parser->sax->serror = &Findings::malformed;
    parser->sax->internalSubset = &Findings::typed;
    XmlDocument document(readMemory(parser, text.data(), text.size()));
    xmlFreeParserCtxt(parser);
    xmlNode* root = document ? xmlDocGetRootElement(document.get()) : nullptr;
    if (!root && errors.empty()) findings.add(1, "geofx", "nothing stands here; expected: a scene in XML.");
    if (errors.empty()) validate(document.get(), findings);
    return errors.empty() ? std::move(document) : nullptr;
}

XmlDocument makeSceneXml(const SceneElement& scene, const std::string& text, const std::string& file,
                         std::vector<std::string>& errors)
{
    initialize();
    Findings findings(file, errors);
    XmlDocument document(xmlNewDoc(xmlChars("1.0")));
    xmlDocSetRootElement(document.get(), makeElement(scene, scene.name, findings));
    if (const XmlDocument whole = readLeniently(text))
    {
        if (const xmlNode* first = firstScene(reinterpret_cast<xmlNode*>(whole.get())))
            takeLines(xmlDocGetRootElement(document.get()), first);
    }
    if (errors.empty()) validate(document.get(), findings);
    return errors.empty() ? std::move(document) : nullptr;
}

} // namespace osgGeoFX
