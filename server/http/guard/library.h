// Calls that differ between versions of cpp-httplib, for the guard alone. ADR 12 says what the versions do differently.
#pragma once

#include <httplib.h>

#include <functional>
#include <string>

namespace tunewright::server::http {

/// Called by the library when it has read a head.
using HeadHook = std::function<void(httplib::Request&)>;

/// One request and its answer, by the library's process_request(). False where the connection must end.
/// Version 0.11 asks the stream for the addresses; nothing here uses what the library knows of them.
inline bool process(httplib::Server& server,
                    bool (httplib::Server::*process_request)(httplib::Stream&, bool, bool&, const HeadHook&),
                    httplib::Stream& stream, const HeadHook& on_head) {
    bool closed = false;
    return (server.*process_request)(stream, false, closed, on_head);
}

/// The same by version 0.18, which is given the addresses.
inline bool process(httplib::Server& server,
                    bool (httplib::Server::*process_request)(httplib::Stream&, const std::string&, int,
                                                             const std::string&, int, bool, bool&, const HeadHook&),
                    httplib::Stream& stream, const HeadHook& on_head) {
    bool closed = false;
    return (server.*process_request)(stream, {}, 0, {}, 0, false, closed, on_head);
}

}  // namespace tunewright::server::http
