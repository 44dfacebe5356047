// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Events made by hand for one handler, in a viewer that never draws.
#pragma once

#include <gtest/gtest.h>
#include <osgViewer/Viewer>

#include <functional>

namespace geofx::test
{

/// Places are those of the viewport, whose corner is not the window's. Each event tells whether the handler has taken it.
class WindowEvents : public ::testing::Test
{
protected:
    using Event = osgGA::GUIEventAdapter;
    static constexpr double WIDTH = 1280.0, HEIGHT = 720.0;

    WindowEvents()
    {
        viewer.getCamera()->setViewport(10, 20, static_cast<int>(WIDTH), static_cast<int>(HEIGHT));
    }

    virtual osgGA::GUIEventHandler& handler() = 0;

    bool send(Event::EventType type, const std::function<void(Event&)>& fill)
    {
        osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        fill(*event);
        return handler().handle(*event, viewer);
    }
    bool press(int key)
    {
        return send(Event::KEYDOWN, [&](Event& event) { event.setKey(key); });
    }
    bool mouse(Event::EventType type, const osg::Vec2d& place, int button = Event::LEFT_MOUSE_BUTTON)
    {
        return send(type,
                    [&](Event& event)
                    {
                        event.setX(static_cast<float>(place.x() + 10.0));
                        event.setY(static_cast<float>(place.y() + 20.0));
                        event.setButton(button);
                        event.setButtonMask(static_cast<unsigned int>(button));
                    });
    }
    bool click(const osg::Vec2d& place, int button = Event::LEFT_MOUSE_BUTTON)
    {
        const bool taken = mouse(Event::PUSH, place, button);
        EXPECT_EQ(mouse(Event::RELEASE, place, button), taken);
        return taken;
    }
    void frame()
    {
        send(Event::FRAME, [](Event&) {});
    }

    /// The first overlay, and what it shows.
    osg::Camera& overlay() { return *viewer.getSlave(0)._camera; }
    osg::Group& picture() { return *overlay().getChild(0)->asGroup(); }

    osgViewer::Viewer viewer;
};

} // namespace geofx::test
