// Files of api/ that are compiled in.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

struct EmbeddedFile {
    std::string_view name;  ///< path below api/, e.g. "examples/09-tclab-step.json"
    std::string_view text;
};

/// All of them, sorted by name. The build generates this function (embed.cmake), so that the binary can serve them
/// anywhere.
const std::vector<EmbeddedFile>& embedded_files();

/// The text of one file, such as embedded_file("openapi/paths.json"); it lasts as long as the process. Throws
/// std::logic_error if it is missing, which is a fault of the build.
inline std::string_view embedded_file(std::string_view name) {
    const auto& files = embedded_files();
    const auto found = std::ranges::find(files, name, &EmbeddedFile::name);
    if (found == files.end()) throw std::logic_error("the file " + std::string(name) + " is not compiled in");
    return found->text;
}

}  // namespace tunewright::api
