// `tunewright key NAME`: a new API key.
#pragma once

#include <string>

namespace tunewright::server {

struct KeyCommand {
    std::string name;
    std::string file;  ///< "": standard error gets what may stand in such a file
};

/// Prints the key, which nobody keeps, and adds its digest to the file, readable by its owner alone where it is new.
/// Returns the process' exit code.
int make_key(const KeyCommand& command);

}  // namespace tunewright::server
