// The page for browsers: read into memory once, so that no request can name a file.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/http/app/compression.h"
#include "server/http/message.h"

namespace tunewright::server::http {

class StaticFiles {
public:
    /// Reads the folder; if it is missing, or has no index.html, a plain page explains how to build it.
    explicit StaticFiles(const std::string& folder);

    /// The file at the request's path with its headers; "/" is index.html, and ".html" may be left out. Empty if there
    /// is none.
    std::optional<Response> find(const Request& request) const;

    std::size_t size() const { return files_.size(); }

private:
    struct File {
        ConstantBody body;
        bool immutable = false;  ///< its name changes with its content
    };
    void add(const std::string& path, std::string body);

    std::map<std::string, File, std::less<>> files_;
};

}  // namespace tunewright::server::http
