// One request of a batch, cut out of what was sent.
#pragma once

#include <optional>
#include <string>

#include "api/problem.h"

namespace tunewright::api {

struct RawEntry {
    long line = 0;                 ///< of the body, from 1, where it begins
    std::string text;              ///< a tuning request, if it is one
    std::optional<Problem> fault;  ///< why it is none, known before it is read
    std::string name;              ///< of one with a fault, where it is known
};

/// The fault of a request that has `bytes` bytes where `most` are accepted.
Problem too_long(std::size_t bytes, std::size_t most);

}  // namespace tunewright::api
