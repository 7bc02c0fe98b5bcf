// SHA-256 (FIPS 180-4) of a text, which identifies a request in results, and the encodings and signatures that use it.
// By OpenSSL.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace tunewright::api {

/// Hash of a text that comes in pieces.
class Sha256 {
public:
    Sha256();
    void update(std::string_view piece);
    /// 64 hexadecimal digits of all pieces together.
    std::string hex() const;
    /// Its 32 bytes.
    std::string bytes() const;

private:
    struct Free {
        void operator()(evp_md_ctx_st* context) const;
    };
    std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// 64 hexadecimal digits.
std::string sha256_hex(std::string_view text);

/// Base64 with padding (RFC 4648, section 4): of any bytes, and of the digest, as policies of pages name a stylesheet.
std::string base64(std::string_view bytes);
std::string sha256_base64(std::string_view text);
/// Decodes Base64; empty if the text is not exactly as base64() writes it.
std::optional<std::string> base64_bytes(std::string_view text);

/// HMAC-SHA256 (RFC 2104), its 32 bytes.
std::string hmac_sha256(std::string_view key, std::string_view text);

}  // namespace tunewright::api
