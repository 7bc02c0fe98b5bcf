// The commands that answer one request without a server: `tunewright tune` and `tunewright identify`.
#pragma once

#include <string>

#include "api/service.h"

namespace tunewright::server {

/// Reads a tuning request from the file ("-": standard input). The result goes to standard output and 0 is returned; a
/// problem goes to standard error as problem JSON and 1 is returned.
int tune(const std::string& file);

struct IdentifyCommand {
    std::string file;  ///< "-": standard input
    api::CsvRequest question;
};

/// Reads a CSV file or a log as it is, or a request of POST /v1/identify where the file is one JSON object. The answer
/// goes to standard output and 0 is returned; a problem goes to standard error as problem JSON and 1 is returned. The
/// only limit on the file's size is that of a record, 2,000,000 samples.
int identify(const IdentifyCommand& command);

}  // namespace tunewright::server
