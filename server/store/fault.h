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

/// How many of its steps a schema has taken, and how many this program knows.
struct SchemaState {
    int have = 0;
    int known = 0;
};

/// Who brings the tables of a store up to date when a newer program comes.
enum class SchemaSteps {
    take,   ///< whoever opens it
    leave,  ///< `tunewright migrate`: until then it cannot be opened
};

/// Thrown when a store is opened that is to be brought up to date by somebody else, and has not been yet.
class SchemaBehind : public StoreError {
public:
    explicit SchemaBehind(const std::string& sentence) : StoreError({StoreFault::Kind::unavailable, sentence}) {}
    explicit SchemaBehind(const SchemaState& state)
        : SchemaBehind("its schema is at step " + std::to_string(state.have) + " of " + std::to_string(state.known) +
                       "; `tunewright migrate` brings it up to date") {}
};

/// Runs `work`, which opens the store that people know as `shown`; what it throws becomes a sentence about that.
template <class Work>
auto opening(const std::string& shown, Work work) {
    const auto sentence = [&](const std::exception& error) {
        return "Cannot open the store " + shown + ": " + error.what() + ".";
    };
    try {
        return work();
    } catch (const SchemaBehind& error) {
        throw SchemaBehind(sentence(error));
    } catch (const StoreError& error) {
        throw StoreError({error.kind, sentence(error)});
    } catch (const std::exception& error) {
        throw StoreError({StoreFault::Kind::unavailable, sentence(error)});
    }
}

template <class T>
using Outcome = std::variant<T, StoreFault>;
/// Runs on the store's own thread once the change is durable: quick, and never throws.
template <class T>
using Done = std::function<void(Outcome<T>)>;

}  // namespace tunewright::server
