// The browser's page: read into memory once, so that no request ever names a file.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/http/app/compression.h"
#include "server/http/message.h"

namespace tunewright::server::http {

class StaticFiles {
public:
    /// Reads the folder; one that is missing, or has no index.html, gives a plain page that says how to build it.
    explicit StaticFiles(const std::string& folder);

    /// The file at the request's path ("/" is index.html) with its headers; nothing where there is none.
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
