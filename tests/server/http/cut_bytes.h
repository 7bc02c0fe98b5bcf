// Bytes that reach a connection in chosen pieces: packets of a local socket, each of which is one read.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "server/http/guard/connection.h"

namespace tunewright::server::http {

/// A client that sends all the bytes, then the end, and reads nothing.
class CutBytes {
public:
    /// At most about 270 pieces.
    template <class Size>
    CutBytes(std::string_view bytes, const Size& next_size) {
        if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends_) != 0) std::abort();
        while (!bytes.empty()) {
            const std::size_t n = std::min<std::size_t>(bytes.size(), next_size());
            if (::send(ends_[1], bytes.data(), n, MSG_NOSIGNAL | MSG_DONTWAIT) != static_cast<ssize_t>(n)) std::abort();
            bytes.remove_prefix(n);
        }
        ::shutdown(ends_[1], SHUT_WR);
    }
    ~CutBytes() { ::close(ends_[1]); }
    CutBytes(const CutBytes&) = delete;
    CutBytes& operator=(const CutBytes&) = delete;

    /// The other end, which the caller owns.
    int socket() const { return ends_[0]; }

private:
    int ends_[2];
};

/// Reads the rest of the body; false if it is incomplete.
inline bool read_body(Connection& connection, std::string& body) {
    char piece[4096];
    ssize_t n = 0;
    while ((n = connection.read(piece, sizeof piece)) > 0) body.append(piece, static_cast<std::size_t>(n));
    return n == 0;
}

}  // namespace tunewright::server::http
