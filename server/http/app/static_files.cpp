#include "server/http/app/static_files.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace tunewright::server::http {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 16 * 1024 * 1024;

// Only the service's own scripts and styles; nothing inline; no framing by others; strings never become markup.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'; require-trusted-types-for 'script'; "
    "trusted-types 'none'";

constexpr const char* kPageIsMissing =
    "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Tunewright</title>\n"
    "<h1>Tunewright is running</h1>\n"
    "<p>Its page has not been built. <code>script/server</code> builds it into <code>build/web</code>; another folder\n"
    "is named with <code>--web DIR</code>.</p>\n"
    "<p>The service itself is complete: <a href=\"/openapi.json\">its description</a>,\n"
    "<a href=\"/v1/methods\">the tuning methods</a>, <a href=\"/v1/examples\">examples of requests</a>.</p>\n</html>\n";

std::string type_of(const std::string& path) {
    constexpr std::array<std::pair<const char*, const char*>, 13> types{{
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".webp", "image/webp"},
        {".ico", "image/x-icon"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".woff2", "font/woff2"},
        {".webmanifest", "application/manifest+json"},
        {".csv", "text/csv; charset=utf-8"},
        {".txt", "text/plain; charset=utf-8"},
    }};
    const std::string extension = fs::path(path).extension().string();
    for (const auto& [name, type] : types)
        if (extension == name) return type;
    return "application/octet-stream";
}

}  // namespace

StaticFiles::StaticFiles(const std::string& folder) {
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        if (it->path().filename().string().starts_with('.')) {
            it.disable_recursion_pending();
            continue;
        }
        if (!it->is_regular_file(error) || it->file_size(error) > kLargestFile) continue;
        std::ifstream file(it->path(), std::ios::binary);
        std::string body{std::istreambuf_iterator<char>(file), {}};
        add("/" + fs::relative(it->path(), folder, error).generic_string(), std::move(body));
    }
    if (!files_.contains("/index.html")) add("/index.html", kPageIsMissing);
}

void StaticFiles::add(const std::string& path, std::string body) {
    files_.insert_or_assign(path, File{{std::move(body), type_of(path)}, path.starts_with("/assets/")});
}

std::optional<Response> StaticFiles::find(const Request& request) const {
    std::string path;
    for (const std::string& segment : request.segments) path.append("/").append(segment);
    auto found = files_.find(path.empty() ? "/index.html" : path);
    if (found == files_.end()) found = files_.find(path + ".html");
    if (found == files_.end()) return std::nullopt;
    const File& file = found->second;
    Response response = file.body.respond(request);
    return response.set("Cache-Control", file.immutable ? "public, max-age=31536000, immutable" : "no-cache")
        .set("Content-Security-Policy", kPagePolicy)
        .set("Cross-Origin-Opener-Policy", "same-origin");
}

}  // namespace tunewright::server::http
