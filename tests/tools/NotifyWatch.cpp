// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>

#include <iostream>
#include <utility>

namespace geofx::test
{

namespace
{

class Handler : public osg::NotifyHandler
{
public:
    explicit Handler(NotifyWatch& watch) : _watch(watch) {}

    void notify(osg::NotifySeverity severity, const char* message) override
    {
        // A change of level flushes a stream that is often empty.
        if (severity <= osg::NOTICE && *message != '\0')
        {
            _watch.report(std::string("OSG: ") + message);
        }
        else
        {
            std::cerr << message;
        }
    }

private:
    NotifyWatch& _watch;
};

} // namespace

NotifyWatch::NotifyWatch() : _formerLevel(osg::getNotifyLevel()), _formerHandler(osg::getNotifyHandler())
{
    // NVIDIA's driver says of most programs that the state at the first draw is not the one that it had guessed.
    ignore("is being recompiled based on GL state");
    // OSG fills the buffers of deleted tiles anew when it has their size. Mesa counts such updates and calls them slow.
    // The deletion goes by the clock, so the message comes in some runs only.
    ignore("to update a GL_STATIC_DRAW buffer");
    // Whatever OSG_NOTIFY_LEVEL says, they must reach us.
    if (_formerLevel < osg::NOTICE) osg::setNotifyLevel(osg::NOTICE);
    osg::setNotifyHandler(new Handler(*this));
}

NotifyWatch::~NotifyWatch()
{
    osg::setNotifyHandler(_formerHandler.get());
    osg::setNotifyLevel(_formerLevel);
}

std::vector<std::string> NotifyWatch::messagesOf(const std::function<void()>& action)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _collecting = true;
    }
    action();
    const std::lock_guard<std::mutex> lock(_mutex);
    _collecting = false;
    return std::exchange(_collected, {});
}

void NotifyWatch::ignore(const std::string& text)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _ignored.push_back(text);
}

void NotifyWatch::report(const std::string& message)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const std::string& text : _ignored)
        if (message.find(text) != std::string::npos) return;
    if (_collecting)
    {
        _collected.push_back(message);
        return;
    }
    ADD_FAILURE() << message;
}

} // namespace geofx::test
