#include "server/http/app/compression.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "server/http/app/negotiation.h"

namespace tunewright::server::http {
namespace {

constexpr int kGzipFormat = 16 + 15;
constexpr int kMemory = 8;
constexpr int kConstantLevel = 9;

std::string* header_of(Response& response, std::string_view name) {
    const auto found =
        std::ranges::find(response.headers, name, [](const auto& header) -> std::string_view { return header.first; });
    return found == response.headers.end() ? nullptr : &found->second;
}

class GzipWriter : public BodyWriter {
public:
    explicit GzipWriter(BodyWriter& out) : out_(out) {}
    bool write(std::string_view piece) override { return piece.empty() || out_.write(packer_.piece(piece)); }
    bool gone() const override { return out_.gone(); }
    void hold(std::size_t bytes) override { out_.hold(bytes); }
    bool end() { return out_.write(packer_.end()); }

private:
    BodyWriter& out_;
    GzipStream packer_;
};

BodyProducer compressed(BodyProducer producer) {
    return [producer = std::move(producer)](BodyWriter& out) {
        GzipWriter packed(out);
        return producer(packed) && packed.end();
    };
}

}  // namespace

struct GzipStream::State : z_stream {};

GzipStream::GzipStream() : state_(std::make_unique<State>()) {
    if (deflateInit2(state_.get(), 1, Z_DEFLATED, kGzipFormat, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib has no memory");
}

GzipStream::~GzipStream() { deflateEnd(state_.get()); }

std::string GzipStream::piece(std::string_view text) { return run(text, Z_SYNC_FLUSH); }

std::string GzipStream::end() { return run({}, Z_FINISH); }

std::string GzipStream::run(std::string_view text, int flush) {
    std::string out;
    state_->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    state_->avail_in = static_cast<uInt>(text.size());
    do {
        std::array<char, 16 * 1024> part;
        state_->next_out = reinterpret_cast<Bytef*>(part.data());
        state_->avail_out = part.size();
        deflate(state_.get(), flush);
        out.append(part.data(), part.size() - state_->avail_out);
    } while (state_->avail_out == 0);
    return out;
}

std::string gzip(std::string_view text, int level) {
    z_stream state{};
    if (deflateInit2(&state, level, Z_DEFLATED, kGzipFormat, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib has no memory");
    std::string out(deflateBound(&state, static_cast<uLong>(text.size())), '\0');
    state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    state.avail_in = static_cast<uInt>(text.size());
    state.next_out = reinterpret_cast<Bytef*>(out.data());
    state.avail_out = static_cast<uInt>(out.size());
    deflate(&state, Z_FINISH);
    out.resize(state.total_out);
    deflateEnd(&state);
    return out;
}

bool accepts_gzip(const Request& request) {
    const std::string list = list_of(request, "Accept-Encoding");
    const double gzip = quality(list, "gzip").value_or(0);
    return gzip > 0 && gzip >= quality(list, "identity").value_or(0);
}

bool is_compressible(std::string_view media_type) {
    const std::string_view type = media_type.substr(0, media_type.find(';'));
    if (type == "text/event-stream") return false;
    return type.starts_with("text/") || type == "application/json" || type.ends_with("+json") ||
           type == "application/x-ndjson" || type == "image/svg+xml";
}

void compress(Response& response, bool client_takes_gzip) {
    const std::string* type = header_of(response, "Content-Type");
    if (type == nullptr || !is_compressible(*type) || header_of(response, "Content-Encoding") != nullptr) return;
    response.set("Vary", "Accept-Encoding");
    if (!client_takes_gzip) return;
    if (std::string* tag = header_of(response, "ETag"); tag != nullptr && !tag->starts_with("W/")) tag->insert(0, "W/");
    if (response.stream) {
        response.stream = compressed(std::move(response.stream));
        response.set("Content-Encoding", "gzip");
    } else if (response.body.size() >= kWorthCompressing) {
        response.body = gzip(response.body);
        response.set("Content-Encoding", "gzip");
    }
}

ConstantBody::ConstantBody(std::string text, std::string media_type)
    : text_(std::move(text)), media_type_(std::move(media_type)), tag_(entity_tag(text_)) {
    if (text_.size() < kWorthCompressing || !is_compressible(media_type_)) return;
    packed_ = gzip(text_, kConstantLevel);
    if (packed_.size() > text_.size() * 9 / 10) packed_.clear();
}

Response ConstantBody::respond(const Request& request) const {
    const bool packed = !packed_.empty() && accepts_gzip(request);
    Response response;
    response.set("Content-Type", media_type_);
    if (!packed_.empty()) response.set("Vary", "Accept-Encoding");
    apply_entity_tag(request, response, packed ? "W/" + tag_ : tag_);
    if (response.status == 304) return response;
    if (packed) response.set("Content-Encoding", "gzip");
    response.body = packed ? packed_ : text_;
    return response;
}

}  // namespace tunewright::server::http
