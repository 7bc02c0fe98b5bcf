#include "server/metrics/memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include "server/config.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kDefault = 512 << 20;
constexpr std::size_t kUnlimited = std::size_t{1} << 50;  // older kernels write a larger number for no limit

std::optional<std::size_t> limit_in(const std::string& file) {
    std::ifstream in(file);
    std::size_t bytes = 0;
    if (!(in >> bytes) || bytes >= kUnlimited) return std::nullopt;  // "max"
    return bytes;
}

/// The limit of the control group of the process, or of one above it.
std::optional<std::size_t> group_limit() {
    std::ifstream groups("/proc/self/cgroup");
    std::optional<std::size_t> min = limit_in("/sys/fs/cgroup/memory/memory.limit_in_bytes");
    const auto take = [&](const std::optional<std::size_t>& limit) {
        if (limit) min = std::min(min.value_or(*limit), *limit);
    };
    for (std::string line; std::getline(groups, line);) {
        const std::size_t colon = line.rfind(':');
        if (colon == std::string::npos) continue;
        const bool unified = line.starts_with("0::");
        if (!unified && line.find("memory") == std::string::npos) continue;
        const std::string root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        const std::string file = unified ? "/memory.max" : "/memory.limit_in_bytes";
        for (std::string path = line.substr(colon + 1); path.size() > 1; path.resize(path.rfind('/')))
            take(limit_in(root + path + file));
        take(limit_in(root + file));
    }
    return min;
}

}  // namespace

std::size_t memory_limit(std::size_t asked) { return asked > 0 ? asked : group_limit().value_or(kDefault); }

void keep_small_memory() {
    ::mallopt(M_ARENA_MAX, static_cast<int>(2 * core_count()));
    ::mallopt(M_MMAP_THRESHOLD, 1024 * 1024);
    ::mallopt(M_TRIM_THRESHOLD, 64 * 1024 * 1024);
}

void Memory::look() {
    const auto measure = [this] {
        std::ifstream in("/proc/self/statm");
        std::size_t size = 0, resident = 0;
        in >> size >> resident;
        taken_ = resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    };
    measure();
    if (taken_ <= limit_ / 2) return;
    ::malloc_trim(0);
    measure();
}

}  // namespace tunewright::server
