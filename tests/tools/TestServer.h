// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace geofx::test
{

/** A web server on this machine that has the files of a folder, and faults as wanted. It answers GET, keeps connections open
    and has a thread for each. */
class TestServer
{
public:
    enum class Fault
    {
        None,
        NotFound,  ///< 404
        Broken,    ///< 500
        Busy,      ///< 503
        Truncated, ///< half of the promised length, then the end
        Unnoticed, ///< half, without a promise of a length
        Reset,     ///< the connection is reset instead of an answer
        Silent,    ///< no answer at all
        Page,      ///< a page of HTML instead, and 200
        Gzip       ///< said to be encoded by gzip, which it is not, apart from its first bytes
    };

    /// What there is under a name; nothing: 404.
    using Content = std::function<std::optional<std::string>(const std::string& name)>;

    /// Serves from now on, at a free port.
    explicit TestServer(std::filesystem::path folder);
    /// The same of content that is made when it is asked for, by several threads at once.
    explicit TestServer(Content content);
    ~TestServer();
    TestServer(const TestServer&) = delete;
    TestServer& operator=(const TestServer&) = delete;

    std::string url(const std::string& name) const;
    std::string address() const; ///< 127.0.0.1:PORT

    /// A fault of all files whose names hold a text, of the next so many requests.
    void setFault(Fault fault, const std::string& name = "",
                  std::size_t times = std::numeric_limits<std::size_t>::max());
    /// Before each answer.
    void setDelay(std::chrono::milliseconds delay);
    /// Goes away: nothing listens, and open connections are closed.
    void stop();
    /// Comes back at the same port.
    void start();

    /// The names of all requests so far.
    std::vector<std::string> requests() const;
    std::size_t requestsOf(const std::string& name) const;
    void forgetRequests();
    /// The largest number of requests that waited for their answers at once.
    int mostAtOnce() const { return _mostAtOnce; }

private:
    struct Connection
    {
        int socket = -1;
        std::thread thread;
    };
    void accept(int listener);
    void serve(Connection& connection);
    bool answer(int socket, const std::string& name);

    const Content _content;
    int _port = 0;
    int _listener = -1;
    std::atomic<bool> _stopping{false};
    std::thread _thread;
    mutable std::mutex _mutex; ///< of all below
    std::list<Connection> _connections;
    Fault _fault = Fault::None;
    std::string _faulty;
    std::size_t _times = 0; ///< that the fault is left for
    std::chrono::milliseconds _delay{0};
    std::vector<std::string> _requests;
    std::atomic<int> _atOnce{0};
    std::atomic<int> _mostAtOnce{0};
};

} // namespace geofx::test
