function R = rotation(rpy)
% ROTATION  From the frame to the world, of roll, pitch and yaw (rad); thesis eq. (2.8).
  s = sin(rpy); c = cos(rpy);
  R = [c(2) * c(3), s(1) * s(2) * c(3) - c(1) * s(3), c(1) * s(2) * c(3) + s(1) * s(3); ...
       c(2) * s(3), s(1) * s(2) * s(3) + c(1) * c(3), c(1) * s(2) * s(3) - s(1) * c(3); ...
       -s(2), s(1) * c(2), c(1) * c(2)];
end
