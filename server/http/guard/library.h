// Calls that differ between versions of cpp-httplib, for the guard only. ADR 12 describes the differences.
#pragma once

#include <httplib.h>

#include <functional>
#include <string>

namespace tunewright::server::http {

/// Called by the library when it has read a head.
using HeadHook = std::function<void(httplib::Request&)>;

/// One request and its answer, by the library's process_request(). False if the connection must end. Version 0.11 reads
/// the addresses from the stream; they are not used here.
inline bool process(httplib::Server& server,
                    bool (httplib::Server::*process_request)(httplib::Stream&, bool, bool&, const HeadHook&),
                    httplib::Stream& stream, const HeadHook& on_head) {
    bool closed = false;
    return (server.*process_request)(stream, false, closed, on_head);
}

/// The call of version 0.18, which takes the addresses as arguments.
inline bool process(httplib::Server& server,
                    bool (httplib::Server::*process_request)(httplib::Stream&, const std::string&, int,
                                                             const std::string&, int, bool, bool&, const HeadHook&),
                    httplib::Stream& stream, const HeadHook& on_head) {
    bool closed = false;
    return (server.*process_request)(stream, {}, 0, {}, 0, false, closed, on_head);
}

}  // namespace tunewright::server::http
