#include "server/http/body/body_decoder.h"

#include <algorithm>

namespace tunewright::server::http {
namespace {

constexpr int kMaxSizeDigits = 8;

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

BodyDecoder BodyDecoder::of_length(std::size_t length) {
    BodyDecoder made;
    made.left_ = length;
    if (length == 0) made.state_ = State::done;
    return made;
}

BodyDecoder BodyDecoder::of_chunks(std::size_t limit) {
    BodyDecoder made;
    made.chunked_ = true;
    made.step_ = Step::size;
    made.room_ = limit;
    return made;
}

std::size_t BodyDecoder::decode(std::string_view input, std::string& body, std::size_t room) {
    std::size_t used = 0;
    while (state_ == State::more && used < input.size()) {
        if (step_ != Step::data) {
            take_line_byte(input[used++]);
            continue;
        }
        const std::size_t n = std::min({left_, input.size() - used, room});
        if (n == 0) break;
        body.append(input.substr(used, n));
        used += n;
        room -= n;
        left_ -= n;
        if (left_ > 0) continue;
        if (chunked_)
            step_ = Step::data_end;
        else
            state_ = State::done;
    }
    return used;
}

void BodyDecoder::take_line_byte(char c) {
    const auto expect = [&](char wanted, Step next) {
        if (c != wanted) return refuse(400, "A chunk must end with CR LF, without extensions or trailers.");
        step_ = next;
    };
    switch (step_) {
        case Step::size: {
            const int value = hex_value(c);
            if (value >= 0 && digits_ < kMaxSizeDigits) {
                left_ = left_ * 16 + static_cast<std::size_t>(value);
                digits_++;
            } else if (c == '\r' && digits_ > 0) {
                step_ = Step::size_end;
            } else {
                refuse(400, "The size of a chunk must be 1 to 8 hexadecimal digits, without extensions.");
            }
            return;
        }
        case Step::size_end:
            expect('\n', Step::data);
            if (state_ == State::more) end_size_line();
            return;
        case Step::data_end: return expect('\r', Step::data_end_2);
        case Step::data_end_2: return expect('\n', Step::size);
        case Step::last_end: return expect('\r', Step::last_end_2);
        case Step::last_end_2:
            expect('\n', Step::last_end_2);
            if (state_ == State::more) state_ = State::done;
            return;
        case Step::data: return;
    }
}

void BodyDecoder::end_size_line() {
    digits_ = 0;
    if (left_ > room_) return refuse(413, "The chunks are more than is accepted in one body.");
    room_ -= left_;
    if (left_ == 0) step_ = Step::last_end;
}

void BodyDecoder::refuse(int status, const char* detail) {
    state_ = State::refused;
    status_ = status;
    detail_ = detail;
}

}  // namespace tunewright::server::http
