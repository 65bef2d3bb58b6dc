function R = rotation(rpy)
% ROTATION  Return the rotation matrix from frame to world axes.
%
%   R = quadcore.rotation(rpy)
%
% rpy: roll, pitch and yaw (rad). Thesis eq. (2.8).
  s = sin(rpy); c = cos(rpy);
  R = [c(2) * c(3), s(1) * s(2) * c(3) - c(1) * s(3), c(1) * s(2) * c(3) + s(1) * s(3); ...
       c(2) * s(3), s(1) * s(2) * s(3) + c(1) * c(3), c(1) * s(2) * s(3) - s(1) * c(3); ...
       -s(2), s(1) * c(2), c(1) * c(2)];
end
