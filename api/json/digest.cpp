#include "api/json/digest.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>
#include <stdexcept>

namespace tunewright::api {
namespace {

// OpenSSL fails here only for lack of memory.
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

std::optional<std::string> base64_bytes(std::string_view text) {
    if (text.size() % 4 != 0) return std::nullopt;
    std::string out(3 * (text.size() / 4), '\0');
    const int length =
        EVP_DecodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                        reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
    if (length < 0) return std::nullopt;
    // The decoder counts the padding as bytes.
    for (std::size_t back = 0; back < 2 && text.size() > back && text[text.size() - 1 - back] == '='; back++)
        out.pop_back();
    if (base64(out) != text) return std::nullopt;
    return out;
}

std::string hmac_sha256(std::string_view key, std::string_view text) {
    std::array<unsigned char, 32> mac{};
    const unsigned char* done =
        HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
             reinterpret_cast<const unsigned char*>(text.data()), text.size(), mac.data(), nullptr);
    must(done != nullptr ? 1 : 0);
    return {mac.begin(), mac.end()};
}

std::string sha256_base64(std::string_view text) {
    Sha256 digest;
    digest.update(text);
    return base64(digest.bytes());
}

}  // namespace tunewright::api
