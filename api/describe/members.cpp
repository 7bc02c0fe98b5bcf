#include "api/describe/members.h"

#include <algorithm>
#include <cctype>

#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

/// The sentence "it is required: " with the first sentence of the member's description, whose first letter becomes
/// small unless it begins a symbol.
std::string why_required(const std::string& sentence) {
    const std::size_t end = sentence.find('.');
    std::string first = end == sentence.npos ? sentence + "." : sentence.substr(0, end + 1);
    const bool symbol = first.size() > 1 && (first[1] < 'a' || first[1] > 'z');
    if (!symbol && !first.empty()) first[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(first[0])));
    return "it is required: " + first;
}

}  // namespace

AnyCodec::~AnyCodec() = default;

struct Members::Member {
    std::string name, sentence, unit;
    bool required, answer_only;
    std::ptrdiff_t offset;
    std::unique_ptr<const AnyCodec> codec;
    std::string initial;  ///< the default as JSON text; empty: none

    bool asked() const { return codec->reads() && !answer_only; }
};

Members::Members(std::string_view name, std::string_view sentence) : name_(name), sentence_(sentence) {}
Members::Members(Members&&) noexcept = default;
Members::~Members() = default;

void Members::tag(std::string_view field, std::string_view value, bool required) {
    tag_required_ = required;
    tag_field_ = field;
    tag_value_ = value;
    names_.insert(names_.begin(), tag_field_);
}

void Members::add(std::string_view name, std::string_view sentence, const FieldOptions& options, std::ptrdiff_t offset,
                  std::unique_ptr<const AnyCodec> codec, const void* initial) {
    std::string text;
    if (initial && codec->reads() && !options.required && !options.answer_only && !options.no_default &&
        !codec->skip(initial)) {
        Writer writer;
        codec->write(initial, writer);
        text = writer.take();
    }
    names_.emplace_back(name);
    members_.push_back({std::string(name), std::string(sentence), std::string(options.unit), options.required,
                        options.answer_only, offset, std::move(codec), std::move(text)});
}

void Members::add(std::string_view name, std::string_view sentence, const FieldOptions& options,
                  std::unique_ptr<const AnyCodec> codec) {
    add(name, sentence, options, 0, std::move(codec), nullptr);
}

void Members::refuse(std::string_view name, std::string_view sentence) { refused_.emplace_back(name, sentence); }

void Members::why_null(std::string_view otherwise) { otherwise_ = otherwise; }

void Members::example(Json value) { example_ = std::move(value); }

bool Members::read(const Json& value, void* object, Reader& reader) const {
    if (!value.is_object()) {
        reader.fault(wrong_kind(value, "an object", reader));
        return false;
    }
    for (const auto& [given, content] : value.items()) check_name(given, reader);
    for (const Member& member : members_) {
        const auto at = value.find(member.name);
        if (at == value.end()) {
            if (member.required)
                reader.fault_at(member.name, member.name + " is missing; " + why_required(member.sentence));
        } else if (member.asked()) {
            const Reader::At place(reader, member.name);
            member.codec->read(*at, member_at(object, member.offset), reader);
        }
    }
    return true;
}

void Members::check_name(const std::string& given, Reader& reader) const {
    for (const auto& [name, sentence] : refused_) {
        if (given == name) return reader.fault_at(given, sentence);
    }
    if (given == "why_null" && !otherwise_.empty()) return;
    if (std::find(names_.begin(), names_.end(), given) != names_.end()) return;
    const std::string meant = nearest(given, names_);
    reader.fault_at(given,
                    given + " is not a field here; " +
                        (meant.empty() ? "known are " + listed(names_, "and") + "." : "did you mean " + meant + "?"));
}

void Members::write(const void* object, Writer& out) const {
    out.begin_object();
    if (!tag_field_.empty()) out.key(tag_field_).text(tag_value_);
    std::vector<const Member*> undefined;
    for (const Member& member : members_) {
        const void* value = member_at(object, member.offset);
        if (!member.codec->writes() || member.codec->skip(value)) continue;
        out.key(member.name);
        member.codec->write(value, out);
        if (!otherwise_.empty() && member.codec->undefined(value)) undefined.push_back(&member);
    }
    if (!undefined.empty()) write_reasons(object, undefined, out);
    out.end_object();
}

void Members::write_reasons(const void* object, const std::vector<const Member*>& undefined, Writer& out) const {
    out.key("why_null").begin_object();
    for (const Member* member : undefined) {
        const std::string why = member->codec->why(member_at(object, member->offset));
        out.key(member->name).text(why.empty() ? otherwise_ : why);
    }
    out.end_object();
}

Json Members::schema(SchemaBook& book) const {
    if (!book.components.contains(name_)) {
        book.components[name_] = nullptr;
        Json built = build_schema(book);
        book.components[name_] = std::move(built);
    }
    return {{"$ref", "#/components/schemas/" + name_}};
}

Json Members::properties_schema(SchemaBook& book, bool reads, Json& required) const {
    Json properties = Json::object();
    if (!tag_field_.empty()) {
        properties[tag_field_] = {{"type", "string"}, {"const", tag_value_}};
        if (tag_required_) required.push_back(tag_field_);
    }
    for (const Member& member : members_) {
        Json schema = member.codec->schema(book);
        schema["description"] = member.sentence;
        if (!member.unit.empty()) schema["x-unit"] = member.unit;
        if (!member.initial.empty()) schema["default"] = Json::parse(member.initial);
        if (reads && member.answer_only) schema["readOnly"] = true;
        properties[member.name] = std::move(schema);
        if (reads ? member.required : !member.codec->skips()) required.push_back(member.name);
    }
    if (!otherwise_.empty()) {
        properties["why_null"] = {{"type", "object"},
                                  {"description", "Reason for each field that is null, by name."},
                                  {"additionalProperties", {{"type", "string"}}}};
    }
    return properties;
}

Json Members::build_schema(SchemaBook& book) const {
    const bool reads = std::any_of(members_.begin(), members_.end(), [](const Member& m) { return m.asked(); });
    Json required = Json::array();
    Json properties = properties_schema(book, reads, required);
    Json out{{"type", "object"}, {"title", name_}, {"description", sentence_}, {"properties", std::move(properties)}};
    if (!required.empty()) out["required"] = std::move(required);
    if (reads) {
        Json& written = out[kWritten] = Json::array();
        if (!tag_field_.empty()) written.push_back(tag_field_);
        for (const Member& member : members_)
            if (member.codec->writes() && !member.codec->skips()) written.push_back(member.name);
    }
    out["additionalProperties"] = false;
    if (!example_.is_null()) out["examples"] = Json::array({example_});
    return out;
}

}  // namespace tunewright::api
