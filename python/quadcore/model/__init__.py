"""Models and worlds: files, xacro, XML, overrides and shipped resources."""
