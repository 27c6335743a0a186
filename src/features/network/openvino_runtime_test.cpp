// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/openvino_runtime.h"

#include <gtest/gtest.h>

#include <openvino/op/op.hpp>
#include <openvino/op/parameter.hpp>
#include <openvino/op/result.hpp>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

// Doubles its input, and cannot be written to a file.
class Doubling : public ov::op::Op {
 public:
  OPENVINO_OP("Doubling", "dxslam_test")
  Doubling() = default;
  explicit Doubling(const ov::Output<ov::Node>& input) : Op({input}) {
    constructor_validate_and_infer_types();
  }
  void validate_and_infer_types() override {
    set_output_type(0, get_input_element_type(0), get_input_partial_shape(0));
  }
  std::shared_ptr<ov::Node> clone_with_new_inputs(const ov::OutputVector& inputs) const override {
    return std::make_shared<Doubling>(inputs.at(0));
  }
  bool visit_attributes(ov::AttributeVisitor&) override {
    throw std::runtime_error("this cannot be written");
  }
  bool has_evaluate() const override { return true; }
  bool evaluate(ov::TensorVector& outputs, const ov::TensorVector& inputs) const override {
    for (std::size_t i = 0; i < inputs[0].get_size(); ++i) {
      outputs[0].data<float>()[i] = 2.0F * inputs[0].data<const float>()[i];
    }
    return true;
  }
};

TEST(ModelCompiler, NeedsNoCache) {
  const TestFolder folder;
  ExtractorOptions options;
  options.cache_dir = folder.path();
  const ModelCompiler compiler(ModelManifest(), options);
  EXPECT_EQ(compiler.cache_note(), "");
  const auto input = std::make_shared<ov::op::v0::Parameter>(ov::element::f32, ov::Shape{3});
  const auto output = std::make_shared<ov::op::v0::Result>(std::make_shared<Doubling>(input));
  const auto model =
      std::make_shared<ov::Model>(ov::ResultVector{output}, ov::ParameterVector{input});
  ov::InferRequest request = compiler.compile(model, "doubling");
  std::vector<float> numbers{1.0F, 2.0F, 3.0F};
  request.set_input_tensor(ov::Tensor(ov::element::f32, ov::Shape{3}, numbers.data()));
  infer(request, "doubling");
  EXPECT_EQ(values_of(request.get_output_tensor(0)), (std::vector<float>{2.0F, 4.0F, 6.0F}));
}

}  // namespace
}  // namespace dxslam
