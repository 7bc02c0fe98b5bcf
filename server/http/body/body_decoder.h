// The bytes of a request's body as they come in pieces: of a stated length, or chunked. Strict: no chunk extensions, no
// trailers, each line ended by CR LF. What is found does not depend on how the bytes are split.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace tunewright::server::http {

class BodyDecoder {
public:
    enum class State { more, done, refused };

    static BodyDecoder of_length(std::size_t length);
    /// Refused with 413 where the chunks are more than `limit` bytes together.
    static BodyDecoder of_chunks(std::size_t limit);

    /// Reads from the front of `input`, appends at most `room` bytes of the body to `body`, returns how many bytes of
    /// `input` are used up. What follows the body's end is not touched.
    std::size_t decode(std::string_view input, std::string& body, std::size_t room);

    State state() const { return state_; }
    int status() const { return status_; }          ///< of refused: 400 or 413
    const char* detail() const { return detail_; }  ///< of refused: a sentence for the client
    /// Of a stated length: what is still to come; of chunks: of the present one.
    std::size_t remaining() const { return left_; }

private:
    enum class Step { size, size_end, data, data_end, data_end_2, last_end, last_end_2 };

    void refuse(int status, const char* detail);
    void take_line_byte(char c);
    void end_size_line();

    State state_ = State::more;
    bool chunked_ = false;
    Step step_ = Step::data;
    int digits_ = 0;
    std::size_t left_ = 0;
    std::size_t room_ = 0;  ///< of the limit
    int status_ = 0;
    const char* detail_ = "";
};

}  // namespace tunewright::server::http
