#include "ros/parameters/parameter_server.h"

#include <limits>
#include <sstream>
#include <vector>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

std::string textOf(XmlRpc::XmlRpcValue value, const std::string& name) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      text << static_cast<int>(value);
      return text.str();
    case XmlRpc::XmlRpcValue::TypeDouble:
      text << static_cast<double>(value);
      return text.str();
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      throw Error("parameter " + name + " is neither a number nor a text nor a truth value");
  }
}

bool isBelow(const std::string& prefix, const std::string& name) {
  return name.compare(0, prefix.size(), prefix) == 0;
}

}  // namespace

void loadParameters(const ros::NodeHandle& handle, const ParameterTable& table, const std::string& foreign) {
  std::vector<std::string> names;
  handle.getParamNames(names);
  const std::string prefix = handle.getNamespace() + "/";
  for (const std::string& name : names) {
    if (!isBelow(prefix, name) || (!foreign.empty() && isBelow(prefix + foreign + "/", name))) continue;
    XmlRpc::XmlRpcValue value;
    if (!handle.getParam(name, value)) continue;
    try {
      setParameter(table, name.substr(prefix.size()), textOf(value, name));
    } catch (const Error& error) {
      throw Error("in " + handle.getNamespace() + ": " + error.what());
    }
  }
}

}  // namespace depth_fusion
