// Signatures according to Standard Webhooks 1.0: a receiver that knows the secret can verify the origin and integrity
// of a notification and the time at which it was sent, so that it can refuse an intercepted one that is sent again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server {

/// The bytes of "whsec_" and Base64; empty if the text has another form, or fewer than 24 or more than 64 bytes.
std::optional<std::string> secret_bytes(std::string_view text);

/// "whsec_" and 256 random bits in Base64, the form for the standard's own libraries. Throws std::runtime_error if the
/// system has no random bits.
std::string new_secret();

struct SignedNote {
    std::string id;              ///< the same in each attempt
    std::int64_t timestamp = 0;  ///< of the attempt, in seconds since 1970
    std::string_view body;
};

/// "v1,..." for each of the secrets, separated by blanks: while a secret is being replaced, either is accepted.
std::string signature_of(const SignedNote& note, const std::vector<std::string>& secrets);

}  // namespace tunewright::server
