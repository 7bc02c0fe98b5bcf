#include "server/input_file.h"

#include <fstream>
#include <iostream>
#include <iterator>

namespace tunewright::server {

bool read_input(const std::string& file, std::string& text) {
    if (file == "-") {
        text.assign(std::istreambuf_iterator<char>(std::cin), {});
        return true;
    }
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) return false;
    const std::streamoff size = stream.tellg();
    if (size < 0) {  // no regular file: a pipe has no size
        stream.clear();
        text.assign(std::istreambuf_iterator<char>(stream), {});
        return !stream.bad();
    }
    text.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(text.data(), size);
    return static_cast<bool>(stream);
}

}  // namespace tunewright::server
