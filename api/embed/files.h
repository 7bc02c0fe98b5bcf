// Files of api/ that are compiled in.
#pragma once

#include <string_view>
#include <vector>

namespace tunewright::api {

struct EmbeddedFile {
    std::string_view name;  ///< path below api/, e.g. "examples/09-tclab-step.json"
    std::string_view text;
};

/// In the order of their names.
const std::vector<EmbeddedFile>& embedded_files();

/// The text of one; a missing one is a fault of the build and throws std::logic_error.
std::string_view embedded_file(std::string_view name);

}  // namespace tunewright::api
