"""Vehicles and worlds: files, xacro, XML, values that a user overrides, shipped resources."""
