// SHA-256 (FIPS 180-4) of a text: names a request in results. By OpenSSL.
#pragma once

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace tunewright::api {

/// Of a text that comes in pieces.
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

}  // namespace tunewright::api
