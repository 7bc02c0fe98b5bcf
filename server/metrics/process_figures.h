// The system's figures of this process, under the names that all exporters of Prometheus use.
#pragma once

#include <cstddef>

namespace tunewright::server {

struct ProcessFigures {
    double cpu_seconds = 0;  ///< user and system, since the start
    double start_time = 0;   ///< seconds since 1970
    std::size_t resident_bytes = 0, virtual_bytes = 0;
    std::size_t open_files = 0, max_files = 0;
    std::size_t threads = 0;
};

/// From /proc; figures that cannot be read stay 0.
ProcessFigures process_figures();

}  // namespace tunewright::server
