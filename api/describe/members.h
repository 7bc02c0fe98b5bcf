// The members of a described type, without the type itself: the parts of reading, writing and the schema that are
// common to all types are compiled once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/describe/codec.h"

namespace tunewright::api {

struct FieldOptions {
    bool required = false;
    std::string_view unit = {};  ///< "time", "1/time", "u/y", ... in the user's units
    bool answer_only = false;    ///< accepted and ignored in requests, so that an answer can be sent back
    bool no_default = false;     ///< the description states the default; the member's initial value is a different one
};

/// A codec that takes the address of its value.
class AnyCodec {
public:
    virtual ~AnyCodec();
    virtual bool reads() const = 0;
    virtual bool writes() const = 0;
    virtual bool skips() const = 0;  ///< some values are left out
    virtual void read(const Json& value, void* target, Reader& reader) const = 0;
    virtual void write(const void* value, Writer& out) const = 0;
    virtual Json schema(SchemaBook& book) const = 0;
    virtual bool skip(const void* value) const = 0;
    virtual bool undefined(const void* value) const = 0;
    virtual std::string why(const void* value) const = 0;
};

template <class M>
class CodecOf final : public AnyCodec {
public:
    explicit CodecOf(Codec<M>&& codec) : codec_(std::move(codec)) {}

    bool reads() const override { return bool(codec_.read); }
    bool writes() const override { return bool(codec_.write); }
    bool skips() const override { return bool(codec_.skip); }
    void read(const Json& value, void* target, Reader& reader) const override {
        codec_.read(value, *static_cast<M*>(target), reader);
    }
    void write(const void* value, Writer& out) const override { codec_.write(*static_cast<const M*>(value), out); }
    Json schema(SchemaBook& book) const override { return codec_.schema(book); }
    bool skip(const void* value) const override { return codec_.skip && codec_.skip(*static_cast<const M*>(value)); }
    bool undefined(const void* value) const override {
        return codec_.undefined && codec_.undefined(*static_cast<const M*>(value));
    }
    std::string why(const void* value) const override {
        return codec_.why ? codec_.why(*static_cast<const M*>(value)) : std::string();
    }

private:
    Codec<M> codec_;
};

template <class M>
std::unique_ptr<const AnyCodec> codec_of(Codec<M>&& codec) {
    return std::unique_ptr<const AnyCodec>(new CodecOf<M>(std::move(codec)));
}

class Members {
public:
    Members(std::string_view name, std::string_view sentence);
    Members(Members&&) noexcept;
    ~Members();

    void tag(std::string_view field, std::string_view value, bool required);
    /// Adds a member at this distance, in bytes, from the start of the object; `initial` is the value in a new object.
    void add(std::string_view name, std::string_view sentence, const FieldOptions& options, std::ptrdiff_t offset,
             std::unique_ptr<const AnyCodec> codec, const void* initial);
    /// Adds a member that the codec of the whole object reads and writes.
    void add(std::string_view name, std::string_view sentence, const FieldOptions& options,
             std::unique_ptr<const AnyCodec> codec);
    void refuse(std::string_view name, std::string_view sentence);
    void why_null(std::string_view otherwise);
    void example(Json value);

    const std::string& name() const { return name_; }
    const std::string& tag_value() const { return tag_value_; }
    bool has(std::string_view name) const { return std::ranges::find(names_, name) != names_.end(); }

    /// Reads the given members; false: the value is not an object, which is reported.
    bool read(const Json& value, void* object, Reader& reader) const;
    void write(const void* object, Writer& out) const;
    /// A reference to the component, which is added to the book.
    Json schema(SchemaBook& book) const;

private:
    struct Member;

    void check_name(const std::string& given, Reader& reader) const;
    void write_reasons(const void* object, const std::vector<const Member*>& undefined, Writer& out) const;
    Json properties_schema(SchemaBook& book, bool reads, Json& required) const;
    Json build_schema(SchemaBook& book) const;

    std::string name_, sentence_, tag_field_, tag_value_;
    bool tag_required_ = true;
    std::vector<std::string> names_;
    std::vector<Member> members_;
    std::vector<std::pair<std::string, std::string>> refused_;
    std::string otherwise_;  ///< reason of null figures; empty: the type has none
    Json example_;
};

}  // namespace tunewright::api
