// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/TestServer.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace geofx::test
{

namespace
{

bool send(int socket, const std::string& bytes)
{
    std::size_t sent = 0;
    while (sent < bytes.size())
    {
        const ssize_t now = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (now <= 0) return false;
        sent += static_cast<std::size_t>(now);
    }
    return true;
}

std::string head(const std::string& status, const std::string& fields)
{
    return "HTTP/1.1 " + status + "\r\n" + fields + "\r\n";
}

std::string lengthOf(const std::string& bytes)
{
    return "Content-Length: " + std::to_string(bytes.size()) + "\r\n";
}

} // namespace

TestServer::TestServer(std::filesystem::path folder)
    : TestServer(
          [folder = std::move(folder)](const std::string& name) -> std::optional<std::string>
          {
              // Folders can be opened, too.
              if (!std::filesystem::is_regular_file(folder / name)) return std::nullopt;
              std::ifstream stream(folder / name, std::ios::binary);
              return std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
          })
{
}

TestServer::TestServer(Content content) : _content(std::move(content))
{
    start();
}

TestServer::~TestServer()
{
    stop();
}

std::string TestServer::address() const
{
    return "127.0.0.1:" + std::to_string(_port);
}

std::string TestServer::url(const std::string& name) const
{
    return "http://" + address() + "/" + name;
}

void TestServer::setFault(Fault fault, const std::string& name, std::size_t times)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _times = times;
    _fault = fault;
    _faulty = name;
}

void TestServer::setDelay(std::chrono::milliseconds delay)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _delay = delay;
}

std::vector<std::string> TestServer::requests() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _requests;
}

std::size_t TestServer::requestsOf(const std::string& name) const
{
    const std::vector<std::string> all = requests();
    return static_cast<std::size_t>(std::count(all.begin(), all.end(), name));
}

void TestServer::forgetRequests()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _requests.clear();
}

void TestServer::start()
{
    _stopping = false;
    _listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    ::setsockopt(_listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    place.sin_port = htons(static_cast<std::uint16_t>(_port));
    socklen_t size = sizeof place;
    if (::bind(_listener, reinterpret_cast<sockaddr*>(&place), size) != 0 || ::listen(_listener, 64) != 0 ||
        ::getsockname(_listener, reinterpret_cast<sockaddr*>(&place), &size) != 0)
        throw std::system_error(errno, std::generic_category(), "the test server cannot listen");
    _port = ntohs(place.sin_port);
    _thread = std::thread([this, listener = _listener] { accept(listener); });
}

void TestServer::stop()
{
    if (!_thread.joinable()) return;
    _stopping = true;
    _thread.join();
    ::close(_listener);
    std::list<Connection> connections;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const Connection& each : _connections)
            ::shutdown(each.socket, SHUT_RDWR);
        connections.swap(_connections);
    }
    for (Connection& each : connections)
    {
        each.thread.join();
        ::close(each.socket);
    }
}

void TestServer::accept(int listener)
{
    while (!_stopping)
    {
        pollfd waiting = {listener, POLLIN, 0};
        if (::poll(&waiting, 1, 10) <= 0) continue;
        const int socket = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
        if (socket < 0) continue;
        const std::lock_guard<std::mutex> lock(_mutex);
        Connection& connection = _connections.emplace_back();
        connection.socket = socket;
        connection.thread = std::thread([this, &connection] { serve(connection); });
    }
}

void TestServer::serve(Connection& connection)
{
    const int socket = connection.socket;
    std::string received;
    char buffer[4096];
    while (!_stopping)
    {
        const std::size_t end = received.find("\r\n\r\n");
        if (end == std::string::npos)
        {
            const ssize_t now = ::recv(socket, buffer, sizeof buffer, 0);
            if (now <= 0) break;
            received.append(buffer, static_cast<std::size_t>(now));
            continue;
        }
        const std::size_t start = received.find(" /");
        const std::string name = received.substr(start + 2, received.find(' ', start + 1) - start - 2);
        received.erase(0, end + 4);
        const int atOnce = ++_atOnce;
        int most = _mostAtOnce;
        while (atOnce > most && !_mostAtOnce.compare_exchange_weak(most, atOnce))
        {
        }
        const bool goesOn = answer(socket, name);
        --_atOnce;
        if (!goesOn) break;
    }
    ::shutdown(socket, SHUT_RDWR);
}

bool TestServer::answer(int socket, const std::string& name)
{
    Fault fault = Fault::None;
    std::chrono::milliseconds delay(0);
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _requests.push_back(name);
        if (_times > 0 && name.find(_faulty) != std::string::npos)
        {
            fault = _fault;
            --_times;
        }
        delay = _delay;
    }
    std::this_thread::sleep_for(delay);
    const std::optional<std::string> found = _content(name);
    const std::string bytes = found.value_or("");
    const std::string half = bytes.substr(0, bytes.size() / 2);
    const std::string page = "<html>Welcome to the network of this hotel.</html>";
    switch (fault)
    {
    case Fault::None:
        if (!found) break;
        return send(socket, head("200 OK", lengthOf(bytes)) + bytes);
    case Fault::NotFound:
        break;
    case Fault::Broken:
        return send(socket, head("500 Internal Server Error", "Content-Length: 0\r\n"));
    case Fault::Busy:
        return send(socket, head("503 Service Unavailable", "Content-Length: 0\r\n"));
    case Fault::Truncated:
        send(socket, head("200 OK", lengthOf(bytes)) + half);
        return false;
    case Fault::Unnoticed:
        send(socket, head("200 OK", "Connection: close\r\n") + half);
        return false;
    case Fault::Reset:
    {
        // Closing with linger 0 resets; the descriptor stays ours until the end.
        const linger now = {1, 0};
        ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &now, sizeof now);
        return false;
    }
    case Fault::Silent:
        while (!_stopping)
        {
            pollfd waiting = {socket, POLLIN, 0};
            if (::poll(&waiting, 1, 10) > 0) break; // the client has gone
        }
        return false;
    case Fault::Page:
        return send(socket, head("200 OK", lengthOf(page)) + page);
    case Fault::Gzip:
        return send(socket, head("200 OK", "Content-Encoding: gzip\r\n" + lengthOf("..." + bytes)) +
                                "\x1f\x8b\x08" + bytes);
    }
    return send(socket, head("404 Not Found", lengthOf(page)) + page);
}

} // namespace geofx::test
