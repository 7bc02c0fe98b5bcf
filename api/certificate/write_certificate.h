// A certificate as text: lines of JSON, the claim first, then one leaf a line, depth first (docs/proof.md).
#pragma once

#include <string>

#include "engine/certificate/certificate.h"

namespace tunewright::api {

/// The certificate must have its leaves.
std::string write_certificate(const Certificate& certificate);

/// "pi", "pid_fixed" or "pid_tied".
const char* to_string(CertifiedStructure structure);

}  // namespace tunewright::api
