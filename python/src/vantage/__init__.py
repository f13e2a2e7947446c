# SPDX-License-Identifier: Apache-2.0
"""vantage: explores unknown places with a LiDAR. Here is what the program leaves to Python: `vantage.convert`."""
