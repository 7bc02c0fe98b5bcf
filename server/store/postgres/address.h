// Where a PostgreSQL is: postgresql://user:password@host:port/database?option=value
#pragma once

#include <string>

namespace tunewright::server::postgres {

/// The parts of the address that libpq and people need.
class Address {
public:
    /// Throws StoreError with a sentence where `uri` cannot be read; the sentence does not repeat it, since it may
    /// hold a password.
    explicit Address(const std::string& uri);

    /// For libpq, with time limits for what the address leaves open: no call waits without end for a machine that is
    /// gone.
    const std::string& settings() const { return settings_; }
    /// Host, port and database, for logs and errors: never user or password.
    const std::string& shown() const { return shown_; }

private:
    std::string settings_;
    std::string shown_;
};

}  // namespace tunewright::server::postgres
