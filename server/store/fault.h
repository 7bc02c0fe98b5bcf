// Failures of a store: thrown as an exception by reads, passed to the callback by writes.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <variant>

namespace tunewright::server {

struct StoreFault {
    enum class Kind {
        full,         ///< the disk is full; nothing was changed
        unavailable,  ///< any other failure of the machine; nothing was changed
        unknown,      ///< the connection was lost during a commit, which may have succeeded or not
    };
    Kind kind = Kind::unavailable;
    std::string detail;  ///< for the log
};

/// Thrown by reads and by opening a store.
class StoreError : public std::runtime_error {
public:
    explicit StoreError(const StoreFault& fault) : std::runtime_error(fault.detail), kind(fault.kind) {}
    StoreFault::Kind kind;
};

/// The number of steps that a schema has, and that this program has.
struct SchemaState {
    int have = 0;
    int known = 0;
};

/// Controls the migration of a store's tables by a newer program.
enum class SchemaSteps {
    take,   ///< the process that opens the store
    leave,  ///< `tunewright migrate`: until then the store cannot be opened
};

/// Thrown by opening a store whose migration is left to another process and not done yet.
class SchemaBehind : public StoreError {
public:
    explicit SchemaBehind(const std::string& sentence) : StoreError({StoreFault::Kind::unavailable, sentence}) {}
    explicit SchemaBehind(const SchemaState& state)
        : SchemaBehind("its schema is at step " + std::to_string(state.have) + " of " + std::to_string(state.known) +
                       "; `tunewright migrate` migrates it") {}
};

/// Runs `work`, which opens the store with the printable address `shown`; an exception becomes a sentence about that.
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
/// Runs on the store's own thread once the change is durable; must be quick and must not throw.
template <class T>
using Done = std::function<void(Outcome<T>)>;

}  // namespace tunewright::server
