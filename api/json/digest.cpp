#include "api/json/digest.h"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>

namespace tunewright::api {
namespace {

// OpenSSL fails here for want of memory alone.
void must(int ok) {
    if (ok != 1) throw std::runtime_error("OpenSSL cannot compute a SHA-256 digest.");
}

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) { must(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr)); }

void Sha256::update(std::string_view piece) { must(EVP_DigestUpdate(context_.get(), piece.data(), piece.size())); }

std::string Sha256::bytes() const {
    const Sha256 copy;
    must(EVP_MD_CTX_copy_ex(copy.context_.get(), context_.get()));
    std::array<unsigned char, 32> digest{};
    must(EVP_DigestFinal_ex(copy.context_.get(), digest.data(), nullptr));
    return {digest.begin(), digest.end()};
}

std::string Sha256::hex() const {
    std::string out;
    for (const char c : bytes()) {
        const auto byte = static_cast<unsigned char>(c);
        out += "0123456789abcdef"[byte >> 4];
        out += "0123456789abcdef"[byte & 15];
    }
    return out;
}

std::string sha256_hex(std::string_view text) {
    Sha256 digest;
    digest.update(text);
    return digest.hex();
}

std::string base64(std::string_view bytes) {
    std::string out(4 * ((bytes.size() + 2) / 3) + 1, '\0');
    const int length =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    out.resize(static_cast<std::size_t>(length));
    return out;
}

std::string sha256_base64(std::string_view text) {
    Sha256 digest;
    digest.update(text);
    return base64(digest.bytes());
}

}  // namespace tunewright::api
