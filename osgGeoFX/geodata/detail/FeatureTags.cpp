// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/FeatureTags.h>

#include <cpl_conv.h>
#include <cpl_json.h>
#include <cpl_string.h>

#include <memory>

namespace osgGeoFX
{

namespace
{

/// A quoted text from `at` on, its escapes resolved; `at` is behind it then. False if there is none.
bool quoted(const std::string& text, std::size_t& at, std::string& found)
{
    at = text.find('"', at);
    if (at == std::string::npos) return false;
    found.clear();
    for (++at; at < text.size() && text[at] != '"'; ++at)
    {
        if (text[at] == '\\' && at + 1 < text.size()) ++at;
        found += text[at];
    }
    return at++ < text.size();
}

} // namespace

std::string tagOf(const std::string& tags, const std::string& key)
{
    if (!tags.empty() && tags[0] == '{')
    {
        CPLJSONDocument document;
        return document.LoadMemory(tags) ? document.GetRoot().GetString(key) : std::string();
    }
    std::string name, value;
    for (std::size_t at = 0; quoted(tags, at, name) && quoted(tags, at, value);)
        if (name == key) return value;
    return {};
}

std::string cleanText(const std::string& text)
{
    struct Free
    {
        void operator()(char* bytes) const { CPLFree(bytes); }
    };
    std::string clean = text;
    if (!CPLIsUTF8(text.c_str(), static_cast<int>(text.size())))
    {
        const std::unique_ptr<char, Free> recoded(CPLRecode(text.c_str(), "CP1252", CPL_ENC_UTF8));
        if (recoded) clean = recoded.get();
    }
    std::string result;
    for (const char each : clean)
    {
        const auto byte = static_cast<unsigned char>(each);
        if (each == '\n' || each == '\r' || each == '\t')
            result += ' ';
        else if (byte >= 0x20 && byte != 0x7f)
            result += each;
    }
    return result;
}

FeatureTags::FeatureTags(const OGRFeatureDefn& layer, const std::vector<std::string>& keys)
{
    for (const std::string& key : keys)
    {
        _keys.emplace_back(key, layer.GetFieldIndex(key.c_str()));
        _hasColumn = _hasColumn || _keys.back().second >= 0;
    }
    for (const char* const each : {"other_tags", "all_tags"})
        if (_tags < 0) _tags = layer.GetFieldIndex(each);
}

std::string FeatureTags::of(const OGRFeature& feature) const
{
    const auto textOf = [&](int field)
    {
        return field >= 0 && feature.IsFieldSetAndNotNull(field)
                   ? std::string(feature.GetFieldAsString(field))
                   : std::string();
    };
    const std::string tags = textOf(_tags);
    for (const auto& [key, field] : _keys)
    {
        std::string value = cleanText(textOf(field));
        if (value.empty() && !tags.empty()) value = cleanText(tagOf(tags, key));
        if (value.find_first_not_of(' ') != std::string::npos) return value;
    }
    return {};
}

} // namespace osgGeoFX
