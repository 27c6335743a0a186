# SPDX-License-Identifier: Apache-2.0
"""Training of dxslam's feature network by distillation."""
