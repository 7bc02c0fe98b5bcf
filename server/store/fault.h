// Why a store could not do its work, and how it answers: at once, by an exception where it reads, or later, by a
// callback where it writes.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <variant>

namespace tunewright::server {

struct StoreFault {
    enum class Kind {
        full,         ///< the disk is; nothing was changed
        unavailable,  ///< anything else of the machine's; nothing was changed
        unknown,      ///< the connection was lost during a commit: it may have been done or not
    };
    Kind kind = Kind::unavailable;
    std::string detail;  ///< for the log
};

/// Thrown by reads and when a store is opened.
class StoreError : public std::runtime_error {
public:
    explicit StoreError(const StoreFault& fault) : std::runtime_error(fault.detail), kind(fault.kind) {}
    StoreFault::Kind kind;
};

/// Thrown when a store is opened that is to be brought up to date by somebody else, and has not been yet.
class SchemaBehind : public StoreError {
public:
    explicit SchemaBehind(const std::string& sentence) : StoreError({StoreFault::Kind::unavailable, sentence}) {}
};

template <class T>
using Outcome = std::variant<T, StoreFault>;
/// Runs on the store's own thread once the change is durable: quick, and never throws.
template <class T>
using Done = std::function<void(Outcome<T>)>;

}  // namespace tunewright::server
