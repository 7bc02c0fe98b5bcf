// A certificate as text: lines of JSON, the claim first, then one leaf a line, depth first (docs/proof.md).
#pragma once

#include <string>

#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/certificate/certificate.h"

namespace tunewright::api {

/// The certificate must have its leaves.
std::string write_certificate(const Certificate& certificate);

/// The members `plant`, `structure`, `Tf`, `Ms`, `Mt`, `design` and `upper` of the object that is open.
void write_problem(const CertificateProblem& problem, Writer& out);
/// Reads those members. Throws Json::exception for others.
CertificateProblem read_problem(const Json& json);

/// "pi", "pid_fixed" or "pid_tied".
const char* to_string(CertifiedStructure structure);
CertifiedStructure certified_structure(const std::string& name);

}  // namespace tunewright::api
