// The certificate of a controller of a result, as a file.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "api/chosen_entry.h"
#include "engine/progress.h"

namespace tunewright::api {

inline constexpr const char* kCertificateMediaType = "application/x-ndjson";

/// The proof of the controller number `index` (a decimal, from 0; "": the best), computed again with its leaves: the
/// search is deterministic. Problems: those of choose_entry(); 404 without a certificate; 504 if it was stopped.
std::variant<std::string, Problem> certificate_file(const ResultSource& source, std::string_view index,
                                                    const RunControl& control);

}  // namespace tunewright::api
