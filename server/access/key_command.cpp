#include "server/access/key_command.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>

#include "api/json/digest.h"
#include "server/access/keys.h"

namespace tunewright::server {
namespace {

constexpr int kFailed = 1;
constexpr int kBadName = 2;

/// Appended in one write, so that a service that reads meanwhile sees the line or not.
bool append(const std::string& path, const std::string& line) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    const bool written = ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    return ::close(fd) == 0 && written;
}

}  // namespace

int make_key(const KeyCommand& command) {
    if (!is_key_name(command.name)) {
        std::cerr << "tunewright: the name must be 1 to 64 letters, digits, dots, underscores or hyphens.\n";
        return kBadName;
    }
    const std::string key = new_key();
    const std::string line = command.name + " sha256:" + api::sha256_hex(key) + "\n";
    if (command.file.empty()) {
        std::cerr << "# For the file of keys:\n" << line;
    } else if (!append(command.file, line)) {
        std::cerr << "tunewright: cannot write to " << command.file << ": " << std::strerror(errno) << ".\n";
        return kFailed;
    }
    std::cout << key << std::endl;
    return 0;
}

}  // namespace tunewright::server
