#include "server/notify/signature.h"

#include "api/json/digest.h"
#include "server/random.h"

namespace tunewright::server {
namespace {

constexpr std::string_view kPrefix = "whsec_";
constexpr std::size_t kMinBytes = 24, kMaxBytes = 64, kMadeBytes = 32;

}  // namespace

std::optional<std::string> secret_bytes(std::string_view text) {
    if (!text.starts_with(kPrefix)) return std::nullopt;
    auto bytes = api::base64_bytes(text.substr(kPrefix.size()));
    if (!bytes || bytes->size() < kMinBytes || bytes->size() > kMaxBytes) return std::nullopt;
    return bytes;
}

std::string new_secret() {
    const std::vector<unsigned char> bytes = random_bytes(kMadeBytes);
    return std::string(kPrefix) + api::base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string signature_of(const SignedNote& note, const std::vector<std::string>& secrets) {
    std::string text = note.id + "." + std::to_string(note.timestamp) + ".";
    text += note.body;
    std::string all;
    for (const std::string& secret : secrets)
        all.append(all.empty() ? "v1," : " v1,").append(api::base64(api::hmac_sha256(secret, text)));
    return all;
}

}  // namespace tunewright::server
