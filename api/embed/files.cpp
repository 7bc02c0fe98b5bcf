#include "api/embed/files.h"

#include <stdexcept>
#include <string>

namespace tunewright::api {

std::string_view embedded_file(std::string_view name) {
    for (const EmbeddedFile& file : embedded_files()) {
        if (file.name == name) return file.text;
    }
    throw std::logic_error("the file " + std::string(name) + " is not compiled in");
}

}  // namespace tunewright::api
