#include "common/net/command_content.h"

#include <google/protobuf/descriptor.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/base/utf8.h"

namespace footing::transport {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// The value of a field, or of the `index`-th of a repeated one.
class Value {
 public:
  Value(const Message& message, const FieldDescriptor* field, int index)
      : message_(message), with_(*message.GetReflection()), field_(field), index_(index) {}

  const Message& message() const {
    return repeated() ? with_.GetRepeatedMessage(message_, field_, index_)
                      : with_.GetMessage(message_, field_);
  }
  bool printable() const {
    return text::IsPrintable(repeated() ? with_.GetRepeatedString(message_, field_, index_)
                                        : with_.GetString(message_, field_));
  }
  bool finite_double() const {
    return std::isfinite(repeated() ? with_.GetRepeatedDouble(message_, field_, index_)
                                    : with_.GetDouble(message_, field_));
  }
  bool finite_float() const {
    return std::isfinite(repeated() ? with_.GetRepeatedFloat(message_, field_, index_)
                                    : with_.GetFloat(message_, field_));
  }

 private:
  bool repeated() const { return field_->is_repeated(); }

  const Message& message_;
  const google::protobuf::Reflection& with_;
  const FieldDescriptor* field_;
  int index_;
};

/// What is wrong with the first field that is; empty: nothing. `within` names what `message` is.
std::string Problem(const Message& message, const std::string& within) {
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const std::string name = within + std::string(field->name());
    const int count = field->is_repeated() ? message.GetReflection()->FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      const Value value(message, field, i);
      const auto type = field->type();
      if (type == FieldDescriptor::TYPE_MESSAGE) {
        const std::string inner = Problem(value.message(), name + ".");
        if (!inner.empty()) return inner;
      } else if (type == FieldDescriptor::TYPE_STRING && !value.printable()) {
        return name + " has control characters, which a text must not have";
      } else if ((type == FieldDescriptor::TYPE_DOUBLE && !value.finite_double()) ||
                 (type == FieldDescriptor::TYPE_FLOAT && !value.finite_float())) {
        return name + " is not a finite number";
      }
    }
  }
  return "";
}

}  // namespace

Result<void> CheckContent(const v1::Command& command) {
  if (command.has_set_interface()) {
    v1::SetInterface without_table = command.set_interface();
    without_table.clear_table();
    const std::string problem = Problem(without_table, "set_interface.");
    return problem.empty() ? Result<void>() : UsageError(problem);
  }
  const std::string problem = Problem(command, "");
  return problem.empty() ? Result<void>() : UsageError(problem);
}

}  // namespace footing::transport
