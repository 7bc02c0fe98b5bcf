// Which store an address means.
#pragma once

#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// sqlite:PATH or postgresql://USER:PASSWORD@HOST:PORT/DATABASE (or postgres://). Throws std::invalid_argument with a
/// sentence where it is neither; the sentence never has a password in it.
void check_store_address(const std::string& address);

/// Opens it and brings its schema up to date. Throws as check_store_address() does, and StoreError with a sentence.
std::unique_ptr<JobStore> open_store(const std::string& address);

/// Whether several processes can use it at the same time.
bool is_shared_store(const std::string& address);

}  // namespace tunewright::server
