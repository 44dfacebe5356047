// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Each sentence that readers of files and programs tell stands in a collection, with the input that brings it, or in
// unbrought.list, with the reason why no case brings it.
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <strangers/StrangerRun.h>

#include <cstring>
#include <set>

using namespace geofx::test::strangers;

namespace
{

/// The strings of a C++ source; those that only spaces part are one. Escaped signs are what they stand for.
std::vector<std::string> literalsOf(const std::string& text)
{
    std::vector<std::string> found;
    bool isJoined = false;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (text.compare(i, 2, "//") == 0)
            i = std::min(text.find('\n', i), text.size() - 1);
        else if (text.compare(i, 2, "/*") == 0)
            i = std::min(text.find("*/", i), text.size() - 2) + 1;
        else if (text.compare(i, 3, "R\"(") == 0)
        {
            i = std::min(text.find(")\"", i), text.size() - 2) + 1;
            isJoined = false;
        }
        else if (text[i] == '\'' && i + 2 < text.size() && (text[i + 2] == '\'' || text[i + 1] == '\\'))
        {
            i = text.find('\'', i + 2);
            isJoined = false;
        }
        else if (text[i] == '"')
        {
            if (!isJoined) found.emplace_back();
            for (++i; i < text.size() && text[i] != '"'; ++i)
            {
                const bool isEscaped = text[i] == '\\';
                if (isEscaped) ++i;
                found.back() += isEscaped && text[i] == 'n' ? ' ' : text[i];
            }
            isJoined = true;
        }
        else if (!std::isspace(static_cast<unsigned char>(text[i])))
            isJoined = false;
    }
    return found;
}

/// Each run of white space as one space, without those at both ends.
std::string spaced(const std::string& text)
{
    std::istringstream stream(text);
    std::string result;
    for (std::string word; stream >> word;)
        result += (result.empty() ? "" : " ") + word;
    return result;
}

/// What follows the last number that printf puts into a sentence; %% as printf writes it.
std::string behindNumbers(std::string sentence)
{
    std::size_t at = 0;
    for (std::size_t i = 0; i + 1 < sentence.size(); ++i)
    {
        if (sentence[i] != '%') continue;
        std::size_t end = i + 1;
        while (end < sentence.size() && std::strchr("-+ #0123456789.lz", sentence[end]))
            ++end;
        if (end < sentence.size() && std::strchr("dufgsc", sentence[end])) at = end + 1;
        i = end;
    }
    sentence.erase(0, at);
    for (std::size_t i = 0; (i = sentence.find("%%", i)) != std::string::npos; ++i)
        sentence.erase(i, 1);
    return sentence;
}

/// The ends of sentences that a source may tell people.
std::set<std::string> sentencesOf(const fs::path& source)
{
    std::set<std::string> sentences;
    for (const std::string& each : literalsOf(geofx::test::bytesOf(source.string())))
    {
        const std::string sentence = spaced(each);
        if (std::count(each.begin(), each.end(), ' ') >= 3 && sentence.back() == '.')
            sentences.insert(sentence);
    }
    return sentences;
}

/// The sources of readers and programs. Those of measurements and examples are for people who have the sources.
std::vector<fs::path> sources()
{
    std::vector<fs::path> files;
    for (const char* const part : {"osgGeoFX/geodata", "osgGeoFX/raster", "apps"})
        for (const auto& each : fs::recursive_directory_iterator(fs::path(GEOFX_SOURCE_DIR) / part))
        {
            const std::string name = each.path().string(), extension = each.path().extension().string();
            if (name.find("/apps/bench/") == std::string::npos && name.find("_bench") == std::string::npos &&
                name.find("/apps/examples/") == std::string::npos &&
                (extension == ".cpp" || extension == ".h"))
                files.push_back(each.path());
        }
    return files;
}

/// All that cases expect.
std::string expected()
{
    std::string text;
    for (const std::string& collection : collections())
        for (const Stranger& stranger : readCollection(collection))
            for (const StrangerStep& step : stranger.steps)
            {
                text += spaced(step.answer) + "\n";
                for (const std::string& each : step.told)
                    text += spaced(each) + "\n";
            }
    return text;
}

/// The help of all programs.
std::string helpTexts()
{
    std::string text;
    for (const char* const part : {"render", "panorama", "build", "palette", "cluster", "viewer"})
        text += geofx::test::runProgram(
                    {geofx::test::builtProgram(std::string("osggeofx_") + part), "--help"}, {})
                    .standardOutput +
                "\n";
    return spaced(text);
}

/// Of unbrought.list: FILE: SENTENCE.
std::set<std::string> unbrought()
{
    std::set<std::string> lines;
    std::ifstream stream((folder / "unbrought.list").string());
    for (std::string line; std::getline(stream, line);)
        if (!line.empty() && line[0] != '#') lines.insert(line);
    return lines;
}

} // namespace

TEST(Sentences, HaveInputsThatBringThem)
{
    const std::string said = expected(), help = helpTexts();
    const std::set<std::string> known = unbrought();
    std::set<std::string> unmet;
    std::size_t count = 0;
    for (const fs::path& source : sources())
        for (const std::string& sentence : sentencesOf(source))
        {
            ++count;
            if (said.find(spaced(behindNumbers(sentence))) == std::string::npos &&
                help.find(sentence) == std::string::npos)
                unmet.insert(source.filename().string() + ": " + sentence);
        }
    EXPECT_GT(count, 250u);
    for (const std::string& each : unmet)
        EXPECT_TRUE(known.count(each)) << "Write a case that brings this into a collection:\n" << each;
    for (const std::string& each : known)
        EXPECT_TRUE(unmet.count(each))
            << "Take this out of unbrought.list; a case brings it, or it is gone:\n"
            << each;
}

TEST(Sentences, AreFoundInSources)
{
    EXPECT_EQ(literalsOf(R"(fail("it \"is\" " // "no"
                                 "so."); c = '"'; d = "x\n";)"),
              (std::vector<std::string>{"it \"is\" so.", "x "}));
    EXPECT_EQ(behindNumbers(": from %g to %.1f (2 to 98 %% of them) are."), " (2 to 98 % of them) are.");
}
