#include "server/metrics/process_figures.h"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace tunewright::server {
namespace {

double read_boot_time() {
    std::ifstream file("/proc/stat");
    std::string word;
    double seconds = 0;
    while (file >> word)
        if (word == "btime" && file >> seconds) return seconds;
    return 0;
}

/// Seconds since 1970 at which the system started; 0 if that cannot be read. It is stored: the system computes it from
/// a clock that may be set, and the start time of this process must not change.
double boot_time() {
    static std::atomic<double> known = 0;
    if (known == 0) known = read_boot_time();
    return known;
}

std::size_t open_files() {
    std::error_code fault;
    const std::filesystem::directory_iterator files("/proc/self/fd", fault);
    return fault ? 0 : static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

}  // namespace

ProcessFigures process_figures() {
    ProcessFigures figures;
    std::ifstream file("/proc/self/stat");
    std::string line;
    std::getline(file, line);
    // The second field is the program's name in brackets, which may contain any character.
    const std::size_t name_end = line.rfind(')');
    if (name_end == std::string::npos) return figures;
    std::istringstream fields(line.substr(name_end + 1));
    // Fields of proc(5), from the third on.
    constexpr int kUser = 14, kSystem = 15, kThreads = 20, kStart = 22, kVirtual = 23, kResident = 24;
    const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
    std::string field;
    for (int number = 3; number <= kResident && fields >> field; number++) {
        if (number == 3) continue;  // a letter
        const double value = std::stod(field);
        if (number == kUser || number == kSystem) figures.cpu_seconds += value / ticks;
        if (number == kThreads) figures.threads = static_cast<std::size_t>(value);
        if (number == kStart) figures.start_time = boot_time() + value / ticks;
        if (number == kVirtual) figures.virtual_bytes = static_cast<std::size_t>(value);
        if (number == kResident)
            figures.resident_bytes =
                static_cast<std::size_t>(value) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    }
    figures.open_files = open_files();
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0) figures.max_files = limit.rlim_cur;
    return figures;
}

}  // namespace tunewright::server
