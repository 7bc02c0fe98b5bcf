// `tunewright identify`: a model from one recorded test, without a server.
#pragma once

#include <string>

#include "api/service.h"

namespace tunewright::server {

struct IdentifyCommand {
    std::string file;  ///< "-": standard input
    api::CsvRequest question;
};

/// Reads a CSV file or a log as it is, or a request of POST /v1/identify where the file is one JSON object. The answer
/// goes to standard output and 0 is returned; a problem goes to standard error as problem JSON and 1 is returned. No
/// limit on the file's size but the 2,000,000 samples of a record.
int identify(const IdentifyCommand& command);

}  // namespace tunewright::server
