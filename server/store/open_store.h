// How the service gets its store: the one that an address means, and around it one that measures each operation.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/store/store.h"

namespace tunewright::server {

/// sqlite:PATH or postgresql://USER:PASSWORD@HOST:PORT/DATABASE (or postgres://). Throws std::invalid_argument with a
/// sentence where it is neither; the sentence never has a password in it.
void check_store_address(const std::string& address);

/// Opens it and brings its schema up to date; a SQLite file that is not there is created with its folder. Throws as
/// check_store_address() does, and StoreError with a sentence:
///
///     const auto store = open_store("sqlite:tunewright.db");
std::unique_ptr<JobStore> open_store(const std::string& address);

/// Whether several processes can use it at the same time: true of PostgreSQL alone. The address is not checked.
bool is_shared_store(const std::string& address);

/// `meter` runs on whatever thread the operation ends on: its name, the seconds from the call to the answer, and
/// whether the store could do it.
using StoreMeter = std::function<void(std::string_view operation, double seconds, bool done)>;

std::unique_ptr<JobStore> metered(std::unique_ptr<JobStore> store, StoreMeter meter);

}  // namespace tunewright::server
