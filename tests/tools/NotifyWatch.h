// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Notify>
#include <osg/ref_ptr>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace geofx::test
{

/** While one lives, each message of OSG at level NOTICE or worse fails the running test, in whichever
    thread it comes. (OSG tells at NOTICE, not at WARN, that a program did not link or a frame buffer
    object failed.) There is one at a time. Its report() takes messages of other origin, such as OpenGL's.
    */
class NotifyWatch
{
public:
    NotifyWatch();
    ~NotifyWatch();
    NotifyWatch(const NotifyWatch&) = delete;
    NotifyWatch& operator=(const NotifyWatch&) = delete;

    /// The messages that an action makes; these do not fail the test.
    std::vector<std::string> messagesOf(const std::function<void()>& action);

    /// From now on messages that have this text count as nothing. Say why where you call it.
    void ignore(const std::string& text);

    void report(const std::string& message);

private:
    std::mutex _mutex;
    bool _collecting = false;
    std::vector<std::string> _collected, _ignored;
    osg::NotifySeverity _formerLevel;
    osg::ref_ptr<osg::NotifyHandler> _formerHandler;
};

} // namespace geofx::test
