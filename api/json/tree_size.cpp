#include "api/json/json.h"

namespace tunewright::api {

/// Measured: what an element, a member (beside its name), a container and a text of nlohmann::ordered_json take, with
/// room to grow and what the system's allocator adds.
std::size_t tree_size(std::string_view text) {
    constexpr std::size_t element = 32, member = 32, container = 64, string = 64;
    std::size_t size = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        switch (text[i]) {
            case '"':
                size += quoted ? 0 : string;
                quoted = !quoted;
                break;
            case '\\': i += quoted ? 1 : 0; break;
            case ',': size += quoted ? 1 : element; break;
            case ':': size += quoted ? 1 : member; break;
            case '{':
            case '[': size += quoted ? 1 : container; break;
            default: size += quoted ? 1 : 0;
        }
    }
    return size;
}

}  // namespace tunewright::api
