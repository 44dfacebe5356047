// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Asks what a collection asks, and compares answers and messages.
#pragma once

#include <strangers/StrangerAnswers.h>
#include <tools/NotifyWatch.h>

#include <cpl_error.h>
#include <gtest/gtest.h>

namespace geofx::test::strangers
{

inline const fs::path folder = GEOFX_SOURCE_DIR "/tests/strangers";

/// The cases that the variable GEOFX_STRANGER names by a part of their names; all without it.
inline bool isWanted(const Stranger& stranger)
{
    const char* const part = std::getenv("GEOFX_STRANGER");
    return !part || stranger.name.find(part) != std::string::npos;
}

/// Whatever GDAL tells the terminal is a message, too.
class GdalWatch
{
public:
    explicit GdalWatch(NotifyWatch& watch)
    {
        now = &watch;
        _former = CPLSetErrorHandler(handle);
    }
    ~GdalWatch()
    {
        CPLSetErrorHandler(_former);
        now = nullptr;
    }
    GdalWatch(const GdalWatch&) = delete;
    GdalWatch& operator=(const GdalWatch&) = delete;

private:
    static void CPL_STDCALL handle(CPLErr severity, CPLErrorNum, const char* text)
    {
        if (severity != CE_Debug) now->report(std::string("GDAL: ") + text);
    }
    static inline NotifyWatch* now = nullptr;
    CPLErrorHandler _former;
};

inline std::string withoutSender(const std::string& message)
{
    for (const std::string sender : {"OSG: osgGeoFX: ", "OSG: "})
        if (beginsWith(message, sender)) return message.substr(sender.size());
    return message;
}

inline void ask(const Stranger& stranger, const std::string& collection)
{
    NotifyWatch watch;
    std::vector<std::string> messages;
    Answers answers(messages);
    for (const StrangerText& each : stranger.files)
        answers.write(each);
    for (const StrangerStep& step : stranger.steps)
    {
        messages.clear();
        std::string answer;
        const std::vector<std::string> printed = watch.messagesOf(
            [&]
            {
                if (step.isAsked)
                {
                    const GdalWatch gdal(watch);
                    answer = answers.to(step.words);
                }
                else
                {
                    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
                    answers.to(step.words);
                }
            });
        if (!step.isAsked) continue;
        for (const std::string& each : printed)
            messages.push_back(withoutSender(each));
        const std::string where = collection + ":" + std::to_string(step.line) + ": " + stranger.name;
        EXPECT_TRUE(isAnswer(answer, step.answer))
            << where << "\nanswer:   " << answer << "\nexpected: " << step.answer;
        bool isTold = messages.size() == step.told.size();
        for (std::size_t i = 0; isTold && i < messages.size(); ++i)
            isTold = matchesWords(answers.plain(messages[i]), step.told[i]);
        if (isTold) continue;
        std::string text;
        for (const std::string& each : messages)
            text += ">>> told " + answers.plain(each) + "\n";
        ADD_FAILURE() << where << "\nmessages:\n" << text;
    }
}

/// The names of all collections, without ".txt"; those that run programs begin with "program".
inline std::vector<std::string> collections()
{
    std::vector<std::string> names;
    for (const auto& each : fs::directory_iterator(folder))
        if (each.path().extension() == ".txt") names.push_back(each.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

inline std::vector<std::string> collections(bool programs)
{
    std::vector<std::string> names;
    for (const std::string& each : collections())
        if (beginsWith(each, "program") == programs) names.push_back(each);
    return names;
}

inline std::vector<Stranger> readCollection(const std::string& name)
{
    return readStrangers((folder / (name + ".txt")).string());
}

/// Asks all of a collection. A case that cannot be made fails the test, and the next one goes on.
inline void askAll(const std::string& collection)
{
    for (const Stranger& each : readCollection(collection))
    {
        if (!isWanted(each)) continue;
        try
        {
            ask(each, collection + ".txt");
        }
        catch (const std::exception& fault)
        {
            ADD_FAILURE() << collection << ".txt: " << each.name << ": " << fault.what();
        }
    }
}

} // namespace geofx::test::strangers
