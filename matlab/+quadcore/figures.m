function figures(log, folder)
% FIGURES  Draw a flight as chapter 6 of the thesis does, into PNG files.
%
%   quadcore.figures(quadcore.read_log('flight.mat'), 'figures')
%
% path.png, position.png, attitude.png, rotors.png and, of a guided flight, error.png.
  if ~exist(folder, 'dir')
    mkdir(folder);
  end
  p = [log.x(:), log.y(:), log.z(:)];
  wanted = [];
  if isfield(log, 'topic_reference')
    r = log.topic_reference;
    wanted = [r.x(:), r.y(:), r.z(:)];
  end

  h = begin();
  plot3(p(:, 1), p(:, 2), p(:, 3));
  if ~isempty(wanted)
    hold on
    plot3(wanted(:, 1), wanted(:, 2), wanted(:, 3), '--');
    legend('flown', 'reference');
  end
  grid on
  xlabel('x (m)'); ylabel('y (m)'); zlabel('z (m)');
  finish(h, folder, 'path');

  curves(folder, 'position', log.t, p, wanted, {'x (m)', 'y (m)', 'z (m)'});
  rpy = quadcore.roll_pitch_yaw([log.qx(:), log.qy(:), log.qz(:), log.qw(:)]);
  curves(folder, 'attitude', log.t, rpy * 180 / pi, [], {'roll (deg)', 'pitch (deg)', 'yaw (deg)'});
  names = arrayfun(@(i) sprintf('joint %d (rad/s)', i), 1:size(log.j, 2), 'UniformOutput', false);
  curves(folder, 'rotors', log.t, log.j, [], names);
  if ~isempty(wanted)
    names = {'error of x (m)', 'of y (m)', 'of z (m)'};
    curves(folder, 'error', log.t, p - wanted, [], names);
  end
end

function curves(folder, name, t, columns, wanted, names)
  h = begin();
  n = size(columns, 2);
  for i = 1:n
    subplot(n, 1, i);
    plot(t, columns(:, i));
    if ~isempty(wanted)
      hold on
      plot(t, wanted(:, i), '--');
    end
    grid on
    ylabel(names{i});
  end
  xlabel('t (s)');
  finish(h, folder, name);
end

function h = begin()
  h = figure('visible', 'off');
end

function finish(h, folder, name)
  print(h, fullfile(folder, [name, '.png']), '-dpng', '-r100');
  close(h);
end
