// Signatures as Standard Webhooks 1.0 has them: a receiver that knows the secret sees that a note comes from here, that
// nobody has changed it, and when it was sent, so that one which somebody has caught and sends again is known by its
// age.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server {

/// The bytes of "whsec_" and Base64; nothing where it is none, or of fewer than 24 or more than 64 bytes.
std::optional<std::string> secret_bytes(std::string_view text);

/// "whsec_" and 256 random bits in Base64, as the standard's own libraries take it.
/// Throws std::runtime_error where the system gives none.
std::string new_secret();

struct SignedNote {
    std::string id;              ///< the same in each try
    std::int64_t timestamp = 0;  ///< of the try, in seconds since 1970
    std::string_view body;
};

/// "v1,..." for each of the secrets, with blanks between them: while a secret is being changed either will do.
std::string signature_of(const SignedNote& note, const std::vector<std::string>& secrets);

}  // namespace tunewright::server
